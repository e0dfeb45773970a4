// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "solver/gpu/guard_pass.h"

namespace viscera {

GuardPass::GuardPass(const FeatureSet& features)
    : guard_(gpu::Program::compute("guard.comp", features.defines())), group_size_(features.group_size) {}

void GuardPass::run(const LatticeBuffers& buffers, const Governor::Bounds& bounds, const ToolMotions& motions,
                    double tick_s) const {
  guard_.use();
  guard_.set(0, static_cast<uint32_t>(buffers.active_count));
  guard_.set(1, static_cast<float>(bounds.speed_m_per_s));
  guard_.set(2, static_cast<float>(bounds.energy_j));
  guard_.set(3, static_cast<float>(Governor::kEnergyMargin));
  for (size_t s = 0; s < motions.size(); ++s) {
    const Vector3f speed = ((motions[s].to.position_m - motions[s].from.position_m) / tick_s).cast<float>();
    guard_.set(4 + static_cast<int>(s), {speed.x(), speed.y(), speed.z()});
  }
  gpu::Program::dispatch(buffers.active_count, group_size_);
  gpu::Program::storageBarrier();
}

}  // namespace viscera
