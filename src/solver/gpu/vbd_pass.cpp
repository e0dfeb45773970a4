// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "solver/gpu/vbd_pass.h"

#include <utility>

#include "layout/bindings.h"

namespace viscera {

VbdPass::VbdPass(const FeatureSet& features, const LatticeBuffers& buffers, int iterations, const NodePairs* pairs)
    : implicit_(features, buffers, iterations, 1, pairs), iterations_(iterations), group_size_(features.group_size) {
  for (int tools = 0; tools < (features.tools ? 2 : 1); ++tools) {
    sweep_[tools] = gpu::Program::compute("vbd.comp", ImplicitSubstep::defines(features, tools != 0));
  }
  Coloured coloured = byColour(buffers.store.active.read(), features.volume, buffers.links.network);
  by_colour_ = gpu::Buffer<uint32_t>(coloured.slots, "by colour");
  colours_ = std::move(coloured.colours);
}

void VbdPass::run(LatticeBuffers& buffers, const Substep& step) {
  implicit_.begin(buffers, step);
  const gpu::Program& sweep = sweep_[step.tools];
  for (int iteration = 0; iteration < iterations_; ++iteration) {
    sweep.use();
    implicit_.tell(sweep, buffers, step);
    by_colour_.bindStorage(layout::kBindActive);
    for (const Coloured::Colour& colour : colours_) {
      sweep.set("active_count", colour.count);
      sweep.set("colour_first", colour.first);
      gpu::Program::dispatch(colour.count, group_size_);
      gpu::Program::storageBarrier();
    }
    buffers.store.active.bindStorage(layout::kBindActive);
    implicit_.movePairs(buffers, step, iteration);
  }
  implicit_.end(buffers, step);
}

}  // namespace viscera
