// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "viscera/layout/tool_motion.h"
#include "viscera/model/scene/stylus_config.h"

namespace viscera {

struct Scene;

/// What a kind of tool does to tissue: bits. Kernels ask for these and know no kinds.
enum ToolEffect : uint32_t {
  kPushes = layout::kToolPushes,  ///< nodes out of a swept sphere at the tip
  kHolds = layout::kToolHolds,    ///< the nodes that it took when it began
  kCuts = layout::kToolCuts,      ///< springs that its blade crosses
  kErases = layout::kToolErases,  ///< springs of the nodes near its blade
};

/// What is drawn of a tool in front of its shaft.
enum class ToolTip { kBare, kBall, kJaws, kBlade, kCapsule, kCup };

/// How a tool that holds lets go.
struct Grip {
  double release_speed_m_per_s;  ///< faster nodes are slowed to this
  /// The reaction over a tick above which it lets go what it has; it holds nothing again until a new hold begins.
  double max_force_n = std::numeric_limits<double>::infinity();
};

/// Two fingers on a pivot, which is behind their tips, on the shaft; they open across it, along x of the stylus.
struct Jaws {
  double length_m;        ///< from the pivot to the tips
  double open_rad;        ///< from finger to finger, when they are open; > closed_rad
  double closing_s;       ///< from there to closed, where no hand tells how far they are
  double closed_rad = 0;  ///< from finger to finger, when they are closed
};

/// Closed blades of scissors: tips cross there, edges lie 0.2 mm off the pivot of blades of 12 mm.
constexpr double kClosedBlades_rad = 0.03;

/// @param closed  0: open, 1: closed   @returns rad
constexpr double openingOf(const Jaws& jaws, double closed) {
  return jaws.open_rad + closed * (jaws.closed_rad - jaws.open_rad);
}

/// One kind of tool: all that the rest of the program asks of it. To know what a stylus does, ask its row
/// here, and never which kind it is.
struct ToolKind {
  ToolMode mode;
  uint32_t number;   ///< of the mode, as kernels have it in ToolMotion.info.x
  const char* name;  ///< in scene files
  uint32_t effects;  ///< of ToolEffect
  ToolTip tip;
  std::array<uint8_t, 3> color;                 ///< sRGB of what acts, and of the collar on the shaft
  double (*reach_m)(const StylusConfig&);       ///< of what acts, around the tip or around the blade
  Grip (*grip)(const StylusConfig&) = nullptr;  ///< of kinds that hold
  Jaws (*jaws)(const StylusConfig&) = nullptr;  ///< of kinds with two fingers
  bool closes = false;                          ///< its fingers are blades, which part what is between them
  bool clips = false;                           ///< it sets a clip when its fingers have closed
  bool grips = false;                           ///< it holds what its fingers close on, which slides above its force
  bool burns = false;                           ///< it heats what its tip touches

  constexpr bool does(uint32_t some) const { return (effects & some) != 0; }
  /// It moves nodes: contact kernels run, and their reactions are summed.
  constexpr bool touches() const { return does(kPushes | kHolds); }
  /// It parts springs, along the whole blade: kernels of cuts run, the skin is looked at again.
  constexpr bool severs() const { return does(kCuts | kErases); }
};

/// Of tools whose fingers have no keys of their own, a length and an opening [m, rad].
constexpr double kPlainJaw_m = 0.014, kPlainOpening_rad = 0.44;

inline Jaws plainJaws(const StylusConfig& c) {
  return {kPlainJaw_m, kPlainOpening_rad, c.jaw_closing_s};
}

/// The table. Colours after Okabe and Ito, told apart by colour-blind people too, and all of them from red tissue.
// clang-format off
inline constexpr ToolKind kToolKinds[] = {
    {ToolMode::kNone, layout::kModeNone, "none", 0, ToolTip::kBare, {190, 195, 202},
     [](const StylusConfig&) { return 0.0; }},
    {ToolMode::kProbe, layout::kModeProbe, "probe", kPushes, ToolTip::kBall, {86, 180, 233},
     [](const StylusConfig& c) { return c.probe.radius_m; }},
    {ToolMode::kGrab, layout::kModeGrab, "grab", kHolds, ToolTip::kJaws, {0, 178, 130},
     [](const StylusConfig& c) { return c.grab.radius_m; },
     [](const StylusConfig& c) { return Grip{c.grab.release_speed_m_per_s}; }, plainJaws},
    {ToolMode::kCut, layout::kModeCut, "cut", kCuts, ToolTip::kBlade, {240, 228, 66},
     [](const StylusConfig&) { return 0.0; }},
    {ToolMode::kCutParticles, layout::kModeCutParticles, "cut_particles", kErases, ToolTip::kCapsule, {214, 126, 184},
     [](const StylusConfig& c) { return c.cut_particles.eraser_radius_m; }},
    {ToolMode::kSuction, layout::kModeSuction, "suction", kHolds, ToolTip::kCup, {230, 159, 0},
     [](const StylusConfig& c) { return c.suction.radius_m; },
     [](const StylusConfig& c) { return Grip{c.suction.release_speed_m_per_s, c.suction.max_force_n}; }},
    {ToolMode::kNeedle, layout::kModeNeedle, "needle", 0, ToolTip::kJaws, {213, 94, 0},
     [](const StylusConfig& c) { return c.grab.radius_m; }, nullptr, plainJaws},
    {ToolMode::kScissors, layout::kModeScissors, "scissors", kCuts, ToolTip::kJaws, {0, 114, 178},
     [](const StylusConfig&) { return 0.0; }, nullptr,
     [](const StylusConfig& c) {
       return Jaws{c.scissors.blade_length_m, c.scissors.opening_deg * M_PI / 180, c.scissors.closing_s,
                   kClosedBlades_rad};
     }, true},
    {ToolMode::kGrasper, layout::kModeGrasper, "grasper", kHolds, ToolTip::kJaws, {204, 121, 167},
     [](const StylusConfig& c) { return c.grasper.radius_m; },
     [](const StylusConfig& c) { return Grip{c.grasper.release_speed_m_per_s, c.grasper.max_force_n}; },
     [](const StylusConfig& c) {
       return Jaws{c.grasper.jaw_length_m, c.grasper.opening_deg * M_PI / 180, c.jaw_closing_s};
     }, false, false, true},
    {ToolMode::kClip, layout::kModeClip, "clip", 0, ToolTip::kJaws, {150, 200, 90},
     [](const StylusConfig&) { return 0.0; }, nullptr,
     [](const StylusConfig& c) {
       return Jaws{c.clip.jaw_length_m, 2 * std::atan2(0.5 * c.clip.opening_m, c.clip.jaw_length_m), c.jaw_closing_s};
     }, false, true},
    {ToolMode::kCautery, layout::kModeCautery, "cautery", kPushes, ToolTip::kBall, {255, 120, 60},
     [](const StylusConfig& c) { return c.cautery.radius_m; }, nullptr, nullptr, false, false, false, true},
};
// clang-format on
inline constexpr size_t kToolKindCount = sizeof(kToolKinds) / sizeof(kToolKinds[0]);

/// Is the row of each mode where kindOf() looks for it, is its number that of the kernels, does each kind that holds
/// say how it lets go, and has each that is drawn with jaws some?
constexpr bool toolKindsAreWhole() {
  for (size_t i = 0; i < kToolKindCount; ++i) {
    if (static_cast<size_t>(kToolKinds[i].mode) != i || kToolKinds[i].number != i) return false;
    if (kToolKinds[i].does(kHolds) != (kToolKinds[i].grip != nullptr)) return false;
    if ((kToolKinds[i].tip == ToolTip::kJaws) != (kToolKinds[i].jaws != nullptr)) return false;
  }
  return true;
}
static_assert(toolKindsAreWhole(),
              "rows of kToolKinds stand in the order of ToolMode, numbers are those of kernels, those that hold have a "
              "grip, and jaws are drawn of those that have some");

constexpr const ToolKind& kindOf(ToolMode mode) {
  return kToolKinds[static_cast<size_t>(mode)];
}

/// Where the blade of a stylus begins and ends on its axis.
struct BladeSpan {
  double low_m, high_m;  ///< z in the stylus frame, of which the tip is the origin; low_m < high_m
};

constexpr BladeSpan bladeSpan(const CutConfig& cut) {
  return {cut.blade_side == BladeSide::kShaft ? 0 : -cut.blade_length_m,
          cut.blade_side == BladeSide::kAhead ? 0 : cut.blade_length_m};
}

/// Does a stylus cut, erase or burn, with one button or another?
inline bool maySever(const StylusConfig& config) {
  const auto parts = [](ToolMode mode) { return kindOf(mode).severs() || kindOf(mode).burns; };
  return parts(config.idle) || parts(config.button1) || parts(config.button2);
}

/// Does some stylus set clips, with one button or another?
inline bool mayClip(const std::vector<StylusConfig>& styluses) {
  for (const StylusConfig& stylus : styluses) {
    if (kindOf(stylus.idle).clips || kindOf(stylus.button1).clips || kindOf(stylus.button2).clips) return true;
  }
  return false;
}

/// Does some stylus burn tissue, with one button or another?
inline bool mayBurn(const std::vector<StylusConfig>& styluses) {
  for (const StylusConfig& stylus : styluses) {
    if (kindOf(stylus.idle).burns || kindOf(stylus.button1).burns || kindOf(stylus.button2).burns) return true;
  }
  return false;
}

/// May a stylus push tissue with a probe, with one button or another?
inline bool mayPush(const StylusConfig& stylus) {
  const auto pushes = [](ToolMode mode) { return kindOf(mode).does(kPushes); };
  return pushes(stylus.idle) || pushes(stylus.button1) || pushes(stylus.button2);
}

bool hasThreadsOrClips(const Scene& scene);

/// Does some stylus? What a model and a solver keep of cuts is there only then.
inline bool maySever(const std::vector<StylusConfig>& styluses) {
  for (const StylusConfig& stylus : styluses) {
    if (maySever(stylus)) return true;
  }
  return false;
}

}  // namespace viscera
