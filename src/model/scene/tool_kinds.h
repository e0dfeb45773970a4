// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
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

/// Effects of a kind of tool on tissue: bits. Kernels test these and do not know the kinds.
enum ToolEffect : uint32_t {
  kPushes = layout::kToolPushes,  ///< pushes nodes out of a swept sphere at the tip
  kHolds = layout::kToolHolds,    ///< holds the nodes that it took when it began
  kCuts = layout::kToolCuts,      ///< cuts the springs that its blade crosses
  kErases = layout::kToolErases,  ///< erases the springs of the nodes near its blade
};

/// Shape that is drawn at the front of a tool's shaft.
enum class ToolTip { kBare, kBall, kJaws, kBlade, kCapsule, kCup };

/// Release of a tool that holds.
struct Grip {
  double release_speed_m_per_s;  ///< faster nodes are slowed to this speed [m/s]
  /// Reaction over a tick above which it releases what it holds [N]; it holds nothing again until a new hold begins.
  double max_force_n = std::numeric_limits<double>::infinity();
};

/// Two jaws on a pivot, which is on the shaft behind their tips. They open across the shaft, along x of the stylus.
struct Jaws {
  double length_m;        ///< distance from the pivot to the tips [m]
  double open_rad;        ///< angle between the open jaws [rad]; > closed_rad
  double closing_s;       ///< time from open to closed [s], where no device reports the opening
  double closed_rad = 0;  ///< angle between the closed jaws [rad]
};

/// Closed blades of scissors: the tips cross, and the edges are 0.2 mm off the pivot for blades of 12 mm.
constexpr double kClosedBlades_rad = 0.03;

/// Returns the opening [rad]. @param closed  0: open, 1: closed
constexpr double openingOf(const Jaws& jaws, double closed) {
  return jaws.open_rad + closed * (jaws.closed_rad - jaws.open_rad);
}

/// One kind of tool, with everything that the rest of the program needs to know of it. Other code reads the row of a
/// stylus's mode and never compares modes.
struct ToolKind {
  ToolMode mode;
  uint32_t number;   ///< number of the mode in kernels, ToolMotion.info.x
  const char* name;  ///< name in scene files
  uint32_t effects;  ///< bits of ToolEffect
  ToolTip tip;
  std::array<uint8_t, 3> color;                 ///< sRGB of the tip, and of the collar on the shaft
  double (*reach_m)(const StylusConfig&);       ///< reach around the tip or around the blade [m]
  Grip (*grip)(const StylusConfig&) = nullptr;  ///< for kinds that hold
  Jaws (*jaws)(const StylusConfig&) = nullptr;  ///< for kinds with two jaws
  bool closes = false;                          ///< its jaws are blades, which cut what is between them
  bool clips = false;                           ///< it sets a clip when its jaws have closed
  bool grips = false;  ///< it holds what its jaws close on, which slides above the grip's force
  bool burns = false;  ///< it heats what its tip touches
  bool sucks = false;  ///< it takes away the fluid that lies on tissue within its reach

  constexpr bool does(uint32_t some) const { return (effects & some) != 0; }
  /// Returns whether it moves nodes: contact kernels run, and their reactions are summed.
  constexpr bool touches() const { return does(kPushes | kHolds); }
  /// Returns whether it severs springs along the whole blade: kernels of cuts run, and the surface mesh is updated.
  constexpr bool severs() const { return does(kCuts | kErases); }
};

/// Length and opening of jaws without keys of their own [m, rad].
constexpr double kPlainJaw_m = 0.014, kPlainOpening_rad = 0.44;

inline Jaws plainJaws(const StylusConfig& c) {
  return {kPlainJaw_m, kPlainOpening_rad, c.jaw_closing_s};
}

/// Colours follow Okabe and Ito; colour-blind people can distinguish them, and all of them stand out from red tissue.
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
     [](const StylusConfig& c) { return Grip{c.suction.release_speed_m_per_s, c.suction.max_force_n}; }, nullptr,
     false, false, false, false, true},
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

/// Returns whether the table is consistent. The row of each mode is where kindOf() looks for it, and its number is that
/// of the kernels. Each kind that holds has a grip, and each that is drawn with jaws has jaws.
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

/// Ends of a stylus's blade on its axis.
struct BladeSpan {
  double low_m, high_m;  ///< z in the stylus frame, with the tip as origin [m]; low_m < high_m
};

constexpr BladeSpan bladeSpan(const CutConfig& cut) {
  return {cut.blade_side == BladeSide::kShaft ? 0 : -cut.blade_length_m,
          cut.blade_side == BladeSide::kAhead ? 0 : cut.blade_length_m};
}

/// Returns the radius of a stylus's shaft [m].
constexpr double shaftRadius(const StylusConfig& stylus) {
  return stylus.shaft_radius_m > 0 ? stylus.shaft_radius_m : stylus.shaft_length_m / 40;
}

/// Returns the length of the part behind the tip that is jaws or a blade [m].
inline double workingLength(const StylusConfig& stylus, const ToolKind& kind) {
  if (kind.jaws) return kind.jaws(stylus).length_m;
  return kind.severs() ? bladeSpan(stylus.cut).high_m : 0;
}

/// Returns the distance from the tip to the near end of the axis of a shaft that tissue meets [m]: its round end begins
/// behind jaws or a blade, and does not protrude beyond a ball at the tip.
inline double shaftBegin(const StylusConfig& stylus, const ToolKind& kind) {
  const double ball_m = kind.does(kPushes) ? kind.reach_m(stylus) : 0;
  return workingLength(stylus, kind) + std::max(0.0, shaftRadius(stylus) - ball_m);
}

/// Returns whether tissue meets the shaft of some stylus.
inline bool meetsShafts(const std::vector<StylusConfig>& styluses) {
  for (const StylusConfig& stylus : styluses) {
    if (stylus.shaft_contact) return true;
  }
  return false;
}

/// Returns whether a stylus cuts, erases or burns in any of its modes.
inline bool maySever(const StylusConfig& config) {
  const auto parts = [](ToolMode mode) { return kindOf(mode).severs() || kindOf(mode).burns; };
  return parts(config.idle) || parts(config.button1) || parts(config.button2);
}

/// Returns whether some stylus sets clips in any of its modes.
inline bool mayClip(const std::vector<StylusConfig>& styluses) {
  for (const StylusConfig& stylus : styluses) {
    if (kindOf(stylus.idle).clips || kindOf(stylus.button1).clips || kindOf(stylus.button2).clips) return true;
  }
  return false;
}

/// Returns whether some stylus burns tissue in any of its modes.
inline bool mayBurn(const std::vector<StylusConfig>& styluses) {
  for (const StylusConfig& stylus : styluses) {
    if (kindOf(stylus.idle).burns || kindOf(stylus.button1).burns || kindOf(stylus.button2).burns) return true;
  }
  return false;
}

/// Returns whether a stylus pushes tissue with a probe in any of its modes.
inline bool mayPush(const StylusConfig& stylus) {
  const auto pushes = [](ToolMode mode) { return kindOf(mode).does(kPushes); };
  return pushes(stylus.idle) || pushes(stylus.button1) || pushes(stylus.button2);
}

bool hasSuturesOrClips(const Scene& scene);

/// Returns whether some stylus severs. Only then do a model and a solver keep data on cuts.
inline bool maySever(const std::vector<StylusConfig>& styluses) {
  for (const StylusConfig& stylus : styluses) {
    if (maySever(stylus)) return true;
  }
  return false;
}

}  // namespace viscera
