// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <vector>

#include "solver/thread/chain.h"
#include "solver/thread/thread_touches.h"
#include "viscera/model/scene/scene.h"
#include "viscera/tools/obstacles.h"
#include "viscera/tools/stylus.h"

namespace viscera {

class Archive;

/// What a scene says of a thread, its material and size looked up.
ChainMaterial materialOf(const ThreadConfig& config);
/// Its nodes at first: links of spacing_m along the path, and straight on where it is longer.
/// @throws SceneError  there is no path
std::vector<Vector3d> placesOf(const ThreadConfig& config);

/// All threads of a scene: tick by tick beside the tissue, in substeps of their own.
class ThreadBodies {
 public:
  explicit ThreadBodies(const Scene& scene);

  /// @param motions  of the tick, as solvers take them   @param obstacles  of the scene, over the tick
  void step(const ToolMotions& motions, const ObstacleMotions& obstacles);
  void reset();
  void persist(Archive& archive);
  /// Fingerprint of a state of the tissue and of all threads beside it.
  uint64_t hashWith(uint64_t tissue) const;

  size_t count() const { return threads_.size(); }
  const Chain& chain(size_t thread) const { return threads_[thread].chain; }

 private:
  struct Thread {
    Chain chain;
    ChainAround around;  ///< holds: those of fixed ends, then those of hands
    size_t fixed_holds;
    ThreadTouches touches;
  };
  /// Two neighbours that a stylus holds, for a direction.
  struct Grip {
    uint32_t thread = 0, node = 0;
    bool holds = false;
    std::array<Vector3d, 2> places_m;  ///< in the stylus's frame
    std::array<double, 2> stiffness_kg;
  };
  void changeGrips(const ToolMotions& motions);
  void takeHold(Grip& grip, const Pose& tip, double reach_m) const;
  void substep(size_t thread, double at, const ToolMotions& motions, const layout::ObstacleMotion* obstacles);

  std::vector<StylusConfig> styluses_;
  std::vector<ObstacleConfig> obstacles_;
  double tick_s_;
  int substeps_;
  std::vector<Thread> threads_;
  std::array<Grip, layout::kMaxStyluses> grips_;
  std::vector<layout::ObstacleMotion> ways_;  ///< [substeps * kMaxObstacles]
};

}  // namespace viscera
