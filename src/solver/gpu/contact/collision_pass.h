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

/// Contacts between nodes: finds pairs and computes their impulses on both nodes (collision.h).
/// Owner of shaders/solver/collision/*.comp.
class CollisionPass {
 public:
  /// @param ahead  within an implicit substep: note() instead of run()
  CollisionPass(const Model& model, const Scene& scene, const FeatureSet& features, const LatticeBuffers& buffers,
                bool ahead = false);
  /// Finds the pairs of the current state and writes their impulses into `corrections`. The other state is that before
  /// the substep.
  void run(const LatticeBuffers& buffers, const Substep& step) const;
  using Tell = std::function<void(const gpu::Program&)>;
  /// Finds the pairs at the positions after the increments, for shaders/solver/implicit/implicit_pairs.glsl.
  /// @param also  sets further uniforms of the kernels
  void record(const LatticeBuffers& buffers, const Substep& step, const Tell& also) const;
  void bind() const;
  /// Clears the effects of contacts after an external write to the state; see CpuEnvironment::restart().
  void restart();
  void persist(Archive& archive);

  /// Copies the number of nodes that the last search skipped as crowded into `crowded` of the measurements; 0 if it
  /// skipped none. Does not wait.
  void recordCrowded(const gpu::Buffer<layout::TickStats>& stats) const;

  /// Returns the slots a < b of all pairs found in the current state, ascending, at most 64 per node. For tests. Waits.
  std::vector<CollisionPair> findPairs(const LatticeBuffers& buffers) const;

 private:
  void tell(const gpu::Program& program, const LatticeBuffers& buffers, const Substep& step) const;
  void dispatch(size_t count) const;
  void search(const LatticeBuffers& buffers, const Substep& step) const;

  CollisionConfig config_;
  float widened_;  ///< factor of D_ij at which two nodes touch
  float cell_m_;
  gpu::Program count_, position_, scatter_, order_;
  gpu::Program meet_, push_, pairs_, record_;
  gpu::Buffer<float> touch_depths_;        ///< touchDepths()
  mutable gpu::Buffer<uint32_t> buckets_;  ///< see layout::kBindBuckets and the bindings after it
  gpu::Buffer<uint32_t> unsorted_;
  gpu::Buffer<layout::uvec4> entries_;
  gpu::Buffer<layout::vec4> before_, contacts_, corrections_;
  uint32_t bucket_count_ = 0;
  uint32_t group_size_;
};

}  // namespace viscera
