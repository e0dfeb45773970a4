// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "solver/gpu/contact/cut_pass.h"

namespace viscera {

CutPass::CutPass(const FeatureSet& features) : group_size_(features.group_size) {
  if (features.lattice) lattice_ = compiled("cut.comp", features.defines());
  if (features.network) links_ = compiled("cut_links.comp", features.defines());
  if (features.law) torn_cells_.emplace(features);
}

CutPass::Programs CutPass::compiled(const char* shader, std::vector<std::string> defines) const {
  Programs out;
  out.springs = gpu::Program::compute(shader, defines);
  defines.push_back("PARTICLES");
  out.particles = gpu::Program::compute(shader, defines);
  return out;
}

void CutPass::runOver(const gpu::Program& program, gpu::UniformName what, size_t count, uint32_t stylus,
                      uint32_t spared) const {
  program.use();
  program.set(what, static_cast<uint32_t>(count));
  program.set("stylus", stylus);
  program.set("spared", spared);
  gpu::Program::dispatch(count, group_size_);
  gpu::Program::storageBarrier();
}

void CutPass::run(const LatticeBuffers& buffers, uint32_t stylus, bool particles, uint32_t spared) const {
  const auto chosen = [particles](const Programs& of) -> const gpu::Program& {
    return particles ? of.particles : of.springs;
  };
  if (lattice_) runOver(chosen(*lattice_), "active_count", buffers.store.active_count, stylus, spared);
  if (links_) runOver(chosen(*links_), "spring_count", buffers.links.springs.size(), stylus, spared);
  if (torn_cells_) torn_cells_->run(buffers);
}

}  // namespace viscera
