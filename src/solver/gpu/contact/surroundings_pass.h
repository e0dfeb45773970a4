// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "gpu/program.h"
#include "layout/wind.h"
#include "solver/contact/surroundings.h"
#include "solver/gpu/buffers/lattice_buffers.h"
#include "solver/gpu/contact/collision_pass.h"
#include "solver/tissue/features.h"
#include "solver/tissue/substep.h"

namespace viscera {

struct Scene;

/// Wind, forces on bodies, contacts and obstacles act on what an integrator has made of a substep (physics.md 8).
/// Owner of shaders/solver/collision/surroundings.comp.
class SurroundingsPass {
 public:
  SurroundingsPass(const Model& model, const Scene& scene, const FeatureSet& features, const LatticeBuffers& buffers);
  /// After Surroundings::beginTick(), and after buffers.bind().
  void beginTick(const Surroundings& surroundings);
  /// Before an implicit substep: the obstacles are where its kernels find them.
  void bindObstacles(const Substep& step) const;
  /// Before an implicit substep: wind and forces change the velocities.
  void blow(LatticeBuffers& buffers, const Substep& step, const Surroundings& surroundings) const;
  /// current state -> other state, which becomes the current one. The other one must hold the state before the substep.
  /// After an implicit one contacts between nodes only.
  /// @param step  its index says which of the tick's substeps it is
  void run(LatticeBuffers& buffers, const Substep& step, const Surroundings& surroundings);
  /// The state was written from outside: what contacts did is forgotten.
  void restart();
  void persist(Archive& archive) {
    if (collisions_) collisions_->persist(archive);
  }
  /// To the measurements at the end of a tick: CollisionPass::noteCrowded().
  void noteCrowded(const gpu::Buffer<layout::TickStats>& stats) const;
  /// For tests, only where there are collisions: CollisionPass::findPairs().
  std::vector<CollisionPair> findPairs(const LatticeBuffers& buffers) const;

 private:
  void apply(const gpu::Program& program, LatticeBuffers& buffers, const Substep& step,
             const Surroundings& surroundings) const;
  gpu::Program program_;         ///< all at once, after an explicit substep
  gpu::Program blow_, collide_;  ///< before and after an implicit one, where there is something
  SurroundingsFeatures kinds_;
  WindConfig wind_;
  gpu::Buffer<layout::ObstacleMotion> obstacles_;  ///< [substeps * kMaxObstacles]
  gpu::Buffer<layout::vec4> influences_;           ///< [kMaxBodies] bodyInfluences()
  gpu::Buffer<uint32_t> ring_starts_;
  gpu::Buffer<layout::WindTriangle> rings_;
  std::optional<CollisionPass> collisions_;
  uint32_t group_size_;
  bool tools_;  ///< there are styluses, which feel what the nodes do that they hold
};

}  // namespace viscera
