// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "solver/gpu/forces/row_pass.h"

namespace viscera {

RowPass::RowPass(const char* kernel, const FeatureSet& features, bool awake) : group_size_(features.group_size) {
  std::vector<std::string> defines = features.defines();
  if (awake) defines.push_back("AWAKE");
  program_ = gpu::Program::compute(kernel, defines);
}

RowPass RowPass::differences(const FeatureSet& features, bool awake) {
  return RowPass("rows.comp", features, awake);
}

RowPass RowPass::forces(const FeatureSet& features, bool awake) {
  return RowPass("row_forces.comp", features, awake);
}

void RowPass::run(const LatticeBuffers& buffers) const {
  const size_t nodes = buffers.strengths.walls.nodes.size();
  program_.use();
  program_.set("wall_node_count", static_cast<uint32_t>(nodes));
  gpu::Program::dispatch(nodes, group_size_);
  gpu::Program::storageBarrier();
}

}  // namespace viscera
