// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "gpu/program.h"
#include "layout/wind.h"
#include "solver/contact/environment.h"
#include "solver/gpu/buffers/lattice_buffers.h"
#include "solver/gpu/contact/collision_pass.h"
#include "solver/tissue/features.h"
#include "solver/tissue/substep.h"

namespace viscera {

struct Scene;

/// Kernels that apply wind, forces on bodies, contacts and obstacles to the result of an integrator's substep
/// (physics.md 8).
/// Owner of shaders/solver/collision/environment.comp.
class EnvironmentPass {
 public:
  EnvironmentPass(const Model& model, const Scene& scene, const FeatureSet& features, const LatticeBuffers& buffers);
  /// Binds the buffers and uploads the motions of obstacles. Call it after Environment::beginTick() and buffers.bind().
  void beginTick(const Environment& environment);
  /// Binds the obstacles for the kernels of an implicit substep.
  void bindObstacles(const Substep& step) const;
  /// Adds wind and forces to the velocities, before an implicit substep.
  void blow(LatticeBuffers& buffers, const Substep& step, const Environment& environment) const;
  /// Steps from the current state to the other one, which becomes the current one. The other one must hold the state
  /// before the substep. After an implicit substep, applies contacts between nodes only.
  /// @param step  with its index among the tick's substeps
  void run(LatticeBuffers& buffers, const Substep& step, const Environment& environment);
  /// Clears the effects of contacts after an external write to the state.
  void restart();
  void persist(Archive& archive) {
    if (collisions_) collisions_->persist(archive);
  }
  /// Copies the number of crowded nodes into the measurements at the end of a tick (CollisionPass::recordCrowded()).
  void recordCrowded(const gpu::Buffer<layout::TickStats>& stats) const;
  /// Returns CollisionPass::findPairs(). For tests, only with collisions.
  std::vector<CollisionPair> findPairs(const LatticeBuffers& buffers) const;

 private:
  void apply(const gpu::Program& program, LatticeBuffers& buffers, const Substep& step,
             const Environment& environment) const;
  gpu::Program program_;         ///< everything at once, after an explicit substep
  gpu::Program blow_, collide_;  ///< before and after an implicit substep, if needed
  EnvironmentFeatures kinds_;
  WindConfig wind_;
  gpu::Buffer<layout::ObstacleMotion> obstacles_;  ///< [substeps * kMaxObstacles]
  gpu::Buffer<layout::vec4> influences_;           ///< [kMaxBodies] bodyInfluences()
  gpu::Buffer<uint32_t> ring_starts_;
  gpu::Buffer<layout::WindTriangle> rings_;
  std::optional<CollisionPass> collisions_;
  uint32_t group_size_;
  bool tools_;  ///< there are styluses, which feel the forces on the nodes that they hold
};

}  // namespace viscera
