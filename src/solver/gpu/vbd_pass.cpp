// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "solver/gpu/vbd_pass.h"

#include <utility>

#include "layout/bindings.h"

namespace viscera {

VbdPass::VbdPass(const FeatureSet& features, const LatticeBuffers& buffers, int iterations)
    : implicit_(features, buffers, iterations, 1),
      sweep_(gpu::Program::compute("vbd.comp", ImplicitSubstep::defines(features))),
      iterations_(iterations),
      group_size_(features.group_size) {
  Coloured coloured = byColour(buffers.store.active.read(), features.volume, buffers.links.network);
  by_colour_ = gpu::Buffer<uint32_t>(coloured.slots, "by colour");
  colours_ = std::move(coloured.colours);
}

void VbdPass::run(LatticeBuffers& buffers, const Substep& step) {
  implicit_.begin(buffers, step);
  sweep_.use();
  Substep plain = step;
  plain.tools = false;  // the sweeps know of none
  setSubstep(sweep_, buffers, plain);
  by_colour_.bindStorage(layout::kBindActive);
  for (int iteration = 0; iteration < iterations_; ++iteration) {
    for (const Coloured::Colour& colour : colours_) {
      sweep_.set("active_count", colour.count);
      sweep_.set("colour_first", colour.first);
      gpu::Program::dispatch(colour.count, group_size_);
      gpu::Program::storageBarrier();
    }
  }
  buffers.store.active.bindStorage(layout::kBindActive);
  implicit_.end(buffers, step);
}

}  // namespace viscera
