// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <limits>
#include <vector>

#include "viscera/model/scene/stylus_config.h"
#include "viscera/tools/jaws.h"
#include "viscera/tools/stylus.h"

namespace viscera {

class Archive;

/// What tissue demands of the hands that move in it (physics.md 5).
struct HandLimits {
  /// How far a tip may move in a tick: what tissue could follow, the speed of its waves times the tick. A tip that is
  /// faster, or jumps, follows its pose at that speed.
  double max_travel_m = std::numeric_limits<double>::infinity();
  /// A stylus that appears pushes nothing until tissue is nowhere within this radius, or that of its tip where that is
  /// larger: at depth, the side from which it came is unknown. 0: it pushes at once.
  double feel_radius_m = 0;
  double tick_s = 1.0 / 60;
};

/// Turns stylus samples into motions, tick by tick: modes from buttons, jumps that are no motion (first sample).
class Tools {
 public:
  explicit Tools(const std::vector<StylusConfig>& styluses, const HandLimits& limits = {});
  /// @param between  what jaws close on; without it they have met tissue wherever they are
  ToolMotions advance(const StylusSamples& samples, const FeelTissue& between = {});
  /// The motions of what tools hold: tissue slides in jaws.
  ToolMotions ofHeld(const ToolMotions& motions) const;
  const Fingers& fingers(size_t stylus) const { return fingers_[stylus]; }
  /// Some jaws hold what slides in them: pulled() is due, once the forces of the tick are known.
  bool grips(const ToolMotions& motions) const;
  /// @param force_n  of the tissue on a tool in the last tick, tissue frame
  void pulled(size_t stylus, const StylusMotion& motion, const Vector3d& force_n);
  /// In the tick of the last motions nothing was within the radius in which a stylus feels: it may push from now on.
  void foundOutside(size_t stylus) { inside_[stylus] = false; }
  /// What a stylus does from the next tick on with no button pressed, or while one is. What it holds in another mode is
  /// let go; one that comes to push where it may be inside tissue pushes nothing until it was outside.
  void setMode(size_t stylus, ToolSwitch when, ToolMode mode);
  /// The hands were not followed for a while: what they hold is let go, and they appear again.
  void forget();
  void reset();
  /// Modes too.
  void persist(Archive& archive);
  const std::vector<StylusConfig>& configs() const { return configs_; }

 private:
  void changeMode(size_t stylus, StylusMotion& motion);
  void close(size_t stylus, float told_rad, const FeelTissue& between, StylusMotion& motion);
  void holdBack(StylusMotion& motion) const;
  void feel(size_t stylus, StylusMotion& motion) const;

  std::vector<StylusConfig> configs_;
  HandLimits limits_;
  std::array<StylusSample, layout::kMaxStyluses> last_{};
  std::array<ToolMode, layout::kMaxStyluses> mode_{};
  std::array<bool, layout::kMaxStyluses> inside_{};     ///< may be: it has appeared and was not found outside yet
  std::array<bool, layout::kMaxStyluses> forgotten_{};  ///< what it does begins again
  std::array<Fingers, layout::kMaxStyluses> fingers_;
};

}  // namespace viscera
