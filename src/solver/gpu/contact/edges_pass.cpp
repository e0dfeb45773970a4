// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "solver/gpu/contact/edges_pass.h"

#include "layout/edge_nodes.h"

namespace viscera {

namespace {

/// Returns the size of the list in edges.comp: the count and the slots, then two vectors per slot, aligned to their
/// size.
size_t listBytes() {
  constexpr size_t kVector = sizeof(layout::vec4);
  const size_t slots = (1 + size_t{layout::kMostEdgeNodes}) * sizeof(uint32_t);
  return (slots + kVector - 1) / kVector * kVector + 2 * size_t{layout::kMostEdgeNodes} * kVector;
}

}  // namespace

EdgesPass::EdgesPass(const FeatureSet& features)
    : program_(gpu::Program::compute("edges.comp", features.defines())),
      nodes_(listBytes(), "nodes at edges"),
      group_size_(features.group_size) {}

void EdgesPass::run(const LatticeBuffers& buffers, const Substep& step) const {
  program_.use();
  program_.set("dt_s", step.dt_s);
  program_.set("slot_count", static_cast<uint32_t>(buffers.store.slot_count));
  program_.set("push_speed", step.push_speed_m_per_s);
  program_.set("edge_reach", step.edge_reach_m);
  gpu::Program::dispatch(group_size_, group_size_);
  gpu::Program::storageBarrier();
}

}  // namespace viscera
