// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <vector>

#include "gpu/program.h"
#include "solver/contact/collision.h"
#include "solver/gpu/buffers/lattice_buffers.h"
#include "solver/tissue/features.h"
#include "solver/tissue/substep.h"

namespace viscera {

struct Scene;

class Archive;

/// Contacts between nodes: finds pairs and says what they do to either node (collision.h).
/// Owner of shaders/solver/collision/*.comp.
class CollisionPass {
 public:
  /// @param ahead  within an implicit substep: note() instead of run()
  CollisionPass(const Model& model, const Scene& scene, const FeatureSet& features, const LatticeBuffers& buffers,
                bool ahead = false);
  /// Pairs of the current state and their impulses, into `corrections`. The other state is that before the substep.
  void run(const LatticeBuffers& buffers, const Substep& step) const;
  /// Pairs that the increments lead to, for shaders/solver/implicit/implicit_pairs.glsl. @param also  what kernels are
  /// told too
  using Tell = std::function<void(const gpu::Program&)>;
  void note(const LatticeBuffers& buffers, const Substep& step, const Tell& also) const;
  void bind() const;
  /// The state was written from outside: see CpuSurroundings::restart().
  void restart();
  void persist(Archive& archive);

  /// Copies how many nodes the last search passed over, as they lie in crowds, to `crowded` of the measurements; 0
  /// where it saw everybody. Does not wait.
  void noteCrowded(const gpu::Buffer<layout::TickStats>& stats) const;

  /// For tests: slots a < b of all pairs found in the current state, ascending, 64 per node at most. Waits.
  std::vector<CollisionPair> findPairs(const LatticeBuffers& buffers) const;

 private:
  void tell(const gpu::Program& program, const LatticeBuffers& buffers, const Substep& step) const;
  void dispatch(size_t count) const;
  void search(const LatticeBuffers& buffers, const Substep& step) const;

  CollisionConfig config_;
  float widened_;  ///< of D_ij: how near two touch
  float cell_m_;
  gpu::Program count_, place_, scatter_, order_;
  gpu::Program meet_, push_, pairs_, note_;
  gpu::Buffer<float> touch_depths_;        ///< touchDepths()
  mutable gpu::Buffer<uint32_t> buckets_;  ///< see layout::kBindBuckets, and so on
  gpu::Buffer<uint32_t> unsorted_;
  gpu::Buffer<layout::uvec4> entries_;
  gpu::Buffer<layout::vec4> before_, contacts_, corrections_;
  uint32_t bucket_count_ = 0;
  uint32_t group_size_;
};

}  // namespace viscera
