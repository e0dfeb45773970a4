// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "solver/gpu/guard_pass.h"

#include "tools/motion_packing.h"

namespace viscera {

GuardPass::GuardPass(const FeatureSet& features)
    : guard_(gpu::Program::compute("guard.comp", features.defines())),
      group_size_(features.group_size),
      shafts_(features.shafts) {}

void GuardPass::run(const LatticeBuffers& buffers, const StabilityMonitor::Bounds& bounds, const ToolMotions& motions,
                    double tick_s) const {
  guard_.use();
  guard_.set("active_count", static_cast<uint32_t>(buffers.store.active_count));
  guard_.set("most_speed", static_cast<float>(bounds.speed_m_per_s));
  guard_.set("most_energy_j", static_cast<float>(bounds.energy_j));
  guard_.set("energy_margin", static_cast<float>(StabilityMonitor::kEnergyMargin));
  std::array<Vector3f, layout::kMaxStyluses> tip_speed, spin;
  for (size_t s = 0; s < motions.size(); ++s) {
    tip_speed[s] = ((motions[s].to.position_m - motions[s].from.position_m) / tick_s).cast<float>();
    spin[s] = (turnOfShaft(motions[s]) / tick_s).cast<float>();
  }
  guard_.setVectors("tip_speed", tip_speed[0].data(), 3, tip_speed.size());
  if (shafts_) guard_.setVectors("spin", spin[0].data(), 3, spin.size());
  gpu::Program::dispatch(buffers.store.active_count, group_size_);
  gpu::Program::storageBarrier();
}

}  // namespace viscera
