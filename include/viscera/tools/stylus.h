// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "viscera/layout/limits.h"
#include "viscera/layout/tool_motion.h"
#include "viscera/math/types.h"
#include "viscera/model/scene/scene.h"

namespace viscera {

/// The latest that is known of one stylus: tip pose in the tissue frame, buttons. The shaft points along -z of the
/// stylus frame (away from the tip is +z); the blade reaches from the tip along -z.
struct StylusSample {
  bool valid = false;  ///< false until a first pose has come, and again when the pose is stale
  Pose pose;
  bool button1 = false;
  bool button2 = false;
  SteadyTime received{};  ///< when the pose came, for the measurement of delays; 0 where nobody looked
};
using StylusSamples = std::array<StylusSample, layout::kMaxStyluses>;

/// One stylus over one tick: where it was, where it is, what it does.
struct StylusMotion {
  ToolMode mode = ToolMode::kNone;
  bool present = false;  ///< a valid pose is known, whatever the mode
  Pose from, to;
  bool grab_begins = false;  ///< this tick is the first of a grab
  bool held_back = false;    ///< the tip was faster than tissue can follow: `to` lags behind the pose, and catches up
  bool grab_ends = false;    ///< a grab was let go, or the stylus was lost, at the start of this tick
};
using ToolMotions = std::array<StylusMotion, layout::kMaxStyluses>;

/// Turns stylus samples into motions, tick by tick: modes from buttons, jumps that are no motion (first sample).
class Tools {
 public:
  /// @param max_travel_m  how far a tip may move in a tick: what tissue could follow, the speed of its waves times the
  ///                      tick. A tip that is faster, or jumps, follows its pose at that speed (physics.md 5).
  explicit Tools(const std::vector<StylusConfig>& styluses,
                 double max_travel_m = std::numeric_limits<double>::infinity());
  ToolMotions advance(const StylusSamples& samples);
  void reset();
  const std::vector<StylusConfig>& configs() const { return configs_; }

 private:
  void holdBack(StylusMotion& motion) const;

  std::vector<StylusConfig> configs_;
  double max_travel_m_;
  std::array<StylusSample, layout::kMaxStyluses> last_{};
  std::array<ToolMode, layout::kMaxStyluses> mode_{};
};

/// Motions cut into substeps for the solver: [substeps * kMaxStyluses], substep-major (physics.md 2: tool poses are
/// interpolated over the substeps of a tick).
void interpolateMotions(const ToolMotions& motions, const std::vector<StylusConfig>& configs, int substeps,
                        std::vector<layout::ToolMotion>& out);

/// Reaction force and torque on a stylus, tissue frame, acting at the tip.
struct Reaction {
  Vector3d force_n = Vector3d::Zero();
  Vector3d torque_nm = Vector3d::Zero();
  bool saturated = false;
};

/// Saturates a force and limits its slew from one tick to the next (physics.md 5).
class ForceLimiter {
 public:
  ForceLimiter(double max_force_n, double max_rate_n_per_s);
  Reaction limit(const Reaction& raw, double tick_s);
  void reset() { last_ = Reaction{}; }

 private:
  double max_force_n_, max_rate_n_per_s_;
  Reaction last_;
};

}  // namespace viscera
