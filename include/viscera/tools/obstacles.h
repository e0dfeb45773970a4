// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <limits>
#include <optional>
#include <vector>

#include "viscera/api.h"
#include "viscera/layout/obstacle_motion.h"
#include "viscera/math/types.h"
#include "viscera/model/scene/environment_config.h"
#include "viscera/tools/obstacle_motions.h"

namespace viscera {  // internal
class Archive;
}  // namespace viscera

namespace VISCERA_PUBLIC viscera {

/// Poses of the obstacles of a scene, tick by tick: at rest, moving by their velocity keys, or carried by a tf frame.
class VISCERA_PUBLIC Obstacles {
 public:
  /// @param max_travel_m  largest distance in a tick of the surface of an obstacle that a frame carries, by translation
  /// and rotation together [m]. Faster than waves it would throw tissue instead of pushing it. An obstacle that was
  /// limited catches up over later ticks
  explicit Obstacles(const std::vector<ObstacleConfig>& configs,
                     double max_travel_m = std::numeric_limits<double>::infinity());

  size_t count() const { return configs_.size(); }
  /// Sets the latest pose of the frame that carries an obstacle, tissue frame. The first causes no motion: the obstacle
  /// appears there.
  void setFrame(size_t obstacle, const Pose& frame);
  /// Advances by a tick.
  void advance(double time_s, double tick_s);
  const ObstacleMotions& motions() const { return motions_; }  ///< motions over the last tick
  Pose pose(size_t obstacle) const { return motions_[obstacle].to; }
  bool speedLimited(size_t obstacle) const { return speed_limited_[obstacle]; }  ///< in the last tick
  void reset();  ///< moves them to where they are at time 0; frames keep their poses
  void persist(Archive& archive);

 private:
  Pose placed(size_t obstacle, double time_s, const Pose& frame) const;
  RigidMotion limited(size_t obstacle, const RigidMotion& wanted);

  std::vector<ObstacleConfig> configs_;
  double max_travel_m_;
  std::vector<bool> speed_limited_;
  std::vector<std::optional<Pose>> frames_, frames_before_;
  ObstacleMotions motions_;
};

/// Divides motions into substeps for the solver: [substeps * kMaxObstacles], substep-major. Poses move evenly.
void interpolateObstacles(const std::vector<ObstacleConfig>& configs, const ObstacleMotions& motions, int substeps,
                          double tick_s, std::vector<layout::ObstacleMotion>& out);

}  // namespace viscera
