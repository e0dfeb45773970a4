// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "solver/gpu/slow_pass.h"

#include "solver/tissue/slowing.h"

namespace viscera {

SlowPass::SlowPass(const FeatureSet& features)
    : slow_(gpu::Program::compute("slow.comp", features.defines())), group_size_(features.group_size) {}

void SlowPass::run(const LatticeBuffers& buffers, const Substep& step) const {
  slow_.use();
  slow_.set("active_count", static_cast<uint32_t>(buffers.store.active_count));
  slow_.set("dt_s", step.dt_s);
  slow_.set("most_step", step.most_step);
  slow_.set("keeps", kSlowingKeeps);
  gpu::Program::dispatch(buffers.store.active_count, group_size_);
  gpu::Program::storageBarrier();
}

}  // namespace viscera
