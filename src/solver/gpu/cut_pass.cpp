// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "viscera/solver/gpu/cut_pass.h"

namespace viscera {

CutPass::CutPass(const FeatureSet& features) : group_size_(features.group_size) {
  std::vector<std::string> defines = features.defines();
  springs_ = gpu::Program::compute("cut.comp", defines);
  defines.push_back("PARTICLES");
  particles_ = gpu::Program::compute("cut.comp", defines);
  if (features.volume) torn_cells_.emplace(features);
}

void CutPass::run(const LatticeBuffers& buffers, uint32_t stylus, bool particles) const {
  const gpu::Program& program = particles ? particles_ : springs_;
  program.use();
  program.set(0, static_cast<uint32_t>(buffers.active_count));
  program.set(1, stylus);
  gpu::Program::dispatch(buffers.active_count, group_size_);
  gpu::Program::storageBarrier();
  if (torn_cells_) torn_cells_->run(buffers);
}

}  // namespace viscera
