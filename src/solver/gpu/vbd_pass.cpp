// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "viscera/solver/gpu/vbd_pass.h"

#include "gpu/gl.h"

namespace viscera {

/// Bricks start at multiples of four, so the parities of a node's coordinates are those within its brick.
uint32_t colourOf(uint32_t slot, bool volume) {
  const uint32_t i = slot & 1, j = (slot >> 2) & 1, k = (slot >> 4) & 1;
  return volume ? i + 2 * j + 4 * k : 2 * ((i + j) & 1) + ((j + k) & 1);
}

VbdPass::VbdPass(const FeatureSet& features, const LatticeBuffers& buffers, int iterations)
    : implicit_(features, buffers, iterations, 1),
      sweep_(gpu::Program::compute("vbd.comp", ImplicitSubstep::defines(features))),
      iterations_(iterations),
      group_size_(features.group_size) {
  std::vector<uint32_t> sorted;
  const std::vector<uint32_t> active = buffers.active.read();
  for (uint32_t colour = 0; colour < colourCount(features.volume); ++colour) {
    const uint32_t first = static_cast<uint32_t>(sorted.size());
    for (uint32_t slot : active) {
      if (colourOf(slot, features.volume) == colour) sorted.push_back(slot);
    }
    colours_.push_back({first, static_cast<uint32_t>(sorted.size()) - first});
  }
  by_colour_ = gpu::Buffer<uint32_t>(sorted);
}

void VbdPass::run(LatticeBuffers& buffers, const Substep& step) {
  implicit_.begin(buffers, step);
  sweep_.use();
  Substep plain = step;
  plain.tools = false;  // the sweeps know of none
  setSubstep(buffers, plain);
  by_colour_.bindStorage(layout::kBindActive);
  for (int iteration = 0; iteration < iterations_; ++iteration) {
    for (const Colour& colour : colours_) {
      glUniform1ui(0, colour.count);
      glUniform1ui(7, colour.first);
      gpu::Program::dispatch(colour.count, group_size_);
      gpu::Program::storageBarrier();
    }
  }
  buffers.active.bindStorage(layout::kBindActive);
  implicit_.end(buffers, step);
}

}  // namespace viscera
