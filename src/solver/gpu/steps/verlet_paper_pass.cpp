// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "solver/gpu/steps/verlet_paper_pass.h"

#include "gpu/archive.h"
#include "layout/bindings.h"

namespace viscera {

VerletPaperPass::VerletPaperPass(const FeatureSet& features, const LatticeBuffers& buffers)
    : group_size_(features.group_size) {
  const std::vector<std::string> defines = features.defines();
  const auto variant = [&](const char* feature) {
    std::vector<std::string> more = defines;
    more.push_back(feature);
    return gpu::Program::compute("verlet_paper.comp", more);
  };
  plain_ = gpu::Program::compute("verlet_paper.comp", defines);
  rebuild_ = variant("REBUILD");
  if (features.tools) with_tools_ = variant("TOOLS");
  if (features.law) cells_.emplace(features);
  for (int i = 0; i < 2; ++i) {
    positions_[i] = gpu::Buffer<layout::vec4>(buffers.store.slot_count, "positions");
    position_texels_[i] = gpu::TexelView(positions_[i].raw(), gpu::TexelFormat::kRgba32f);
  }
}

/// x_prev is one substep before x: a substep of another length needs another x_prev.
void VerletPaperPass::rebuild(const LatticeBuffers& buffers, const Substep& step) const {
  positions_[current_].bindStorage(layout::kBindPositions);
  rebuild_.use();
  Substep plain = step;
  plain.tools = false;  // this kernel does not support tools
  setSubstep(rebuild_, buffers, plain);
  gpu::Program::dispatch(buffers.store.active_count, group_size_);
  gpu::Program::storageBarrier();
}

void VerletPaperPass::persist(Archive& archive) {
  for (const int i : {current_, 1 - current_}) gpu::persist(archive, positions_[i]);
  archive.value(last_dt_s_);
}

void VerletPaperPass::run(LatticeBuffers& buffers, const Substep& step) {
  positions_[1 - current_].bindStorage(layout::kBindPositionsBefore);
  if (step.restarted || step.dt_s != last_dt_s_) rebuild(buffers, step);
  last_dt_s_ = step.dt_s;
  if (cells_) cells_->run(buffers);
  position_texels_[current_].bind(layout::kUnitPositions);
  const gpu::Program& program = step.tools ? with_tools_ : plain_;
  program.use();
  setSubstep(program, buffers, step);
  gpu::Program::dispatch(buffers.store.active_count, group_size_);
  gpu::Program::storageBarrier();
  current_ = 1 - current_;
}

}  // namespace viscera
