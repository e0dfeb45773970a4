// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <limits>
#include <vector>

#include "viscera/api.h"
#include "viscera/model/scene/stylus_config.h"
#include "viscera/tools/jaws.h"
#include "viscera/tools/stylus.h"

namespace viscera {  // internal
class Archive;
}  // namespace viscera

namespace VISCERA_PUBLIC viscera {

/// Limits that tissue sets to the motion of tools (physics.md 5).
struct ToolLimits {
  /// Largest distance that a tip moves in a tick [m]: the wave speed of tissue times the tick. A tip that is faster, or
  /// jumps, follows its pose at that speed.
  double max_travel_m = std::numeric_limits<double>::infinity();
  /// Radius [m] that must be free of tissue before a stylus that has appeared pushes, or the radius of its tip where
  /// that is larger: deep in tissue, the side from which it came is unknown. 0: it pushes at once.
  double feel_radius_m = 0;
  double tick_s = 1.0 / 60;
};

/// Converter of stylus samples into motions, tick by tick: modes from buttons; the first sample is a jump without
/// motion.
class VISCERA_PUBLIC Tools {
 public:
  explicit Tools(const std::vector<StylusConfig>& styluses, const ToolLimits& limits = {});
  /// Returns the motions of the next tick. @param between  finds the tissue that jaws close on; without it they have
  /// always met tissue
  ToolMotions advance(const StylusSamples& samples, const FeelTissue& between = {});
  /// Returns the motions of the tissue that tools hold: it slides in jaws.
  ToolMotions ofHeld(const ToolMotions& motions) const;
  const Gripper& fingers(size_t stylus) const { return fingers_[stylus]; }
  /// Returns whether some jaws hold tissue that can slide: pulled() is due once the forces of the tick are known.
  bool grips(const ToolMotions& motions) const;
  /// Lets held tissue slide. @param force_n  of the tissue on a tool in the last tick, tissue frame
  void pulled(size_t stylus, const StylusMotion& motion, const Vector3d& force_n);
  /// Records that nothing was within the stylus's radius in the last motions: it may push from now on.
  void foundOutside(size_t stylus) { inside_[stylus] = false; }
  /// Sets the mode of a stylus from the next tick on, with no button pressed or while one is. What it holds in another
  /// mode is released. If it now pushes and may be inside tissue, it pushes nothing until it has been outside.
  void setMode(size_t stylus, ToolSwitch when, ToolMode mode);
  /// Discards device input from before a pause: tools release what they hold and appear again.
  void clear();
  void reset();
  /// Saves or restores the state, with modes.
  void persist(Archive& archive);
  const std::vector<StylusConfig>& configs() const { return configs_; }

 private:
  void changeMode(size_t stylus, StylusMotion& motion);
  void close(size_t stylus, float angle_rad, const FeelTissue& between, StylusMotion& motion);
  void moveShaft(size_t stylus, StylusMotion& motion);
  void holdBack(const StylusConfig& config, StylusMotion& motion) const;
  void feel(size_t stylus, StylusMotion& motion) const;

  std::vector<StylusConfig> configs_;
  ToolLimits limits_;
  std::array<StylusSample, layout::kMaxStyluses> last_{};
  std::array<ToolMode, layout::kMaxStyluses> mode_{};
  std::array<bool, layout::kMaxStyluses> inside_{};  ///< may be inside: it has appeared and was not found outside yet
  std::array<bool, layout::kMaxStyluses> forgotten_{};  ///< its mode begins again
  std::array<Gripper, layout::kMaxStyluses> fingers_;
  std::array<double, layout::kMaxStyluses> shaft_m_{};  ///< StylusMotion::shaft_to_m of styluses with shaft_contact
};

}  // namespace viscera
