// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <limits>
#include <optional>
#include <vector>

#include "viscera/layout/obstacle_motion.h"
#include "viscera/math/types.h"
#include "viscera/model/scene/environment_config.h"
#include "viscera/tools/obstacle_motions.h"

namespace viscera {

class Archive;

/// Where the obstacles of a scene are, tick by tick: at rest, moving by their velocity keys, or carried by a tf frame.
class Obstacles {
 public:
  /// @param max_travel_m  in a tick, of the surface of one that a frame carries, by going and turning together: faster
  /// than waves it would throw tissue instead of pushing it. One held back catches up over later ticks
  explicit Obstacles(const std::vector<ObstacleConfig>& configs,
                     double max_travel_m = std::numeric_limits<double>::infinity());

  size_t count() const { return configs_.size(); }
  /// The latest pose of the frame that carries an obstacle, tissue frame. The first is no motion: it appears there.
  void setFrame(size_t obstacle, const Pose& frame);
  /// Goes on by a tick.
  void advance(double time_s, double tick_s);
  const ObstacleMotions& motions() const { return motions_; }  ///< over the last tick
  Pose pose(size_t obstacle) const { return motions_[obstacle].to; }
  bool heldBack(size_t obstacle) const { return held_back_[obstacle]; }  ///< in the last tick
  void reset();  ///< to where they are at time 0; frames stay where they are
  void persist(Archive& archive);

 private:
  Pose placed(size_t obstacle, double time_s, const Pose& frame) const;
  RigidMotion limited(size_t obstacle, const RigidMotion& wanted);

  std::vector<ObstacleConfig> configs_;
  double max_travel_m_;
  std::vector<bool> held_back_;
  std::vector<std::optional<Pose>> frames_, frames_before_;
  ObstacleMotions motions_;
};

/// Motions cut into substeps for the solver: [substeps * kMaxObstacles], substep-major. Poses go evenly.
void interpolateObstacles(const std::vector<ObstacleConfig>& configs, const ObstacleMotions& motions, int substeps,
                          double tick_s, std::vector<layout::ObstacleMotion>& out);

}  // namespace viscera
