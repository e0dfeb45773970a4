// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

#include "viscera/layout/obstacle_motion.h"
#include "viscera/math/types.h"
#include "viscera/model/scene/scene.h"

namespace viscera {

/// Where the obstacles of a scene are, tick by tick: at rest, moving by their velocity keys, or carried by a tf frame.
class Obstacles {
 public:
  explicit Obstacles(const std::vector<ObstacleConfig>& configs);

  size_t count() const { return configs_.size(); }
  const std::vector<ObstacleConfig>& configs() const { return configs_; }
  /// The latest pose of the frame that carries an obstacle, tissue frame. The first is no motion: the obstacle appears
  /// there.
  void setFrame(size_t obstacle, const Pose& frame);
  /// Where it is at the start and at the end of a tick, tissue frame. @param time_s  of the tick's start
  struct Motion {
    Pose from, to;
  };
  /// Goes on by a tick. @return whether some obstacle moved in this tick or in the one before
  bool advance(double time_s, double tick_s);
  const std::vector<Motion>& motions() const { return motions_; }  ///< [obstacles] over the last tick
  Pose pose(size_t obstacle) const { return motions_[obstacle].to; }
  void reset();  ///< to where they are at time 0; frames stay where they are

 private:
  Pose placed(size_t obstacle, double time_s, const Pose& frame) const;

  std::vector<ObstacleConfig> configs_;
  std::vector<std::optional<Pose>> frames_, frames_before_;
  std::vector<Motion> motions_;
  bool moved_ = true;
};

/// Motions cut into substeps for the solver: [substeps * kMaxObstacles], substep-major. Position and orientation go
/// evenly.
void interpolateObstacles(const Obstacles& obstacles, int substeps, double tick_s,
                          std::vector<layout::ObstacleMotion>& out);

}  // namespace viscera
