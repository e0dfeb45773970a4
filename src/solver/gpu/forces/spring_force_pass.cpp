// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "solver/gpu/forces/spring_force_pass.h"

namespace viscera {

SpringForcePass::SpringForcePass(const FeatureSet& features)
    : forces_(gpu::Program::compute("spring_forces.comp", features.defines())), group_size_(features.group_size) {}

void SpringForcePass::run(const LatticeBuffers& buffers) const {
  forces_.use();
  forces_.set("owner_count", static_cast<uint32_t>(buffers.links.spring_owners.size()));
  gpu::Program::dispatch(buffers.links.spring_owners.size(), group_size_);
  gpu::Program::storageBarrier();
}

}  // namespace viscera
