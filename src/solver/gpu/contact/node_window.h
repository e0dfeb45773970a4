// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include "gpu/program.h"
#include "solver/gpu/buffers/awake_bricks.h"
#include "solver/gpu/buffers/lattice_buffers.h"
#include "solver/tissue/features.h"

namespace viscera {

/// Access of the host to a few nodes within a tick, for models that run there. It waits for the GPU in every substep.
/// Owner of shaders/solver/tools/node_window.comp.
class NodeWindow {
 public:
  /// @param most  largest number of slots in a call
  /// @param awake  null if nothing sleeps; must outlive the window
  NodeWindow(const FeatureSet& features, size_t most, AwakeBricks* awake);
  /// Reads current displacements and velocities; waits.
  /// @param slots  of nodes, each at most once
  /// @param u_m, v_m_per_s  as long as slots
  void read(const std::vector<uint32_t>& slots, std::vector<Vector3f>& u_m, std::vector<Vector3f>& v_m_per_s);
  /// Changes velocities, and displacements by the effect in one substep. The momentum is added to the reaction of a
  /// stylus. The buffers must be bound.
  /// @param slots  as above
  /// @param dv_m_per_s  as long as slots
  void push(const LatticeBuffers& buffers, uint32_t stylus, float dt_s, const std::vector<uint32_t>& slots,
            const std::vector<Vector3f>& dv_m_per_s);

 private:
  void show(const std::vector<uint32_t>& slots);
  void run(const gpu::Program& program, size_t nodes) const;

  gpu::Program gather_, scatter_;
  AwakeBricks* awake_;
  uint32_t group_size_;
  std::vector<uint32_t> shown_;      ///< content of slots_
  bool wakes_ = true;                ///< some of these nodes may be asleep
  gpu::Buffer<uint32_t> slots_;      ///< [most]
  gpu::Buffer<layout::vec4> moves_;  ///< [2 * most]
  std::vector<layout::vec4> host_;
};

}  // namespace viscera
