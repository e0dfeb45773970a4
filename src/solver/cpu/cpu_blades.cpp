// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
// Access of resisted blades, sutures and needles to the nodes.
#include <algorithm>

#include "solver/cpu/cpu_backend.h"
#include "solver/processes/blade/run_sums.h"

namespace viscera {

void CpuBackend::readNodes(const std::vector<uint32_t>& slots, std::vector<Vector3f>& u_m,
                           std::vector<Vector3f>& v_m_per_s) const {
  const float* const u = lattice_.state.displacement[lattice_.state.current].data();
  const float* const v = lattice_.state.velocity[lattice_.state.current].data();
  for (size_t i = 0; i < slots.size(); ++i) {
    u_m[i] = planesAt(u, slots[i]);
    v_m_per_s[i] = planesAt(v, slots[i]);
  }
}

void CpuBackend::pushNodes(uint32_t stylus, float dt_s, const std::vector<uint32_t>& slots,
                           const std::vector<Vector3f>& dv_m_per_s) {
  float* const u = lattice_.state.displacement[lattice_.state.current].data();
  float* const v = lattice_.state.velocity[lattice_.state.current].data();
  for (size_t i = 0; i < slots.size(); ++i) {
    const uint32_t slot = slots[i];
    const Vector3f& dv = dv_m_per_s[i];
    if (lattice_.strengths.mobility[slot] == 0 || dv.isZero(0)) continue;
    setPlanes(v, slot, planesAt(v, slot) + dv);
    setPlanes(u, slot, planesAt(u, slot) + dt_s * dv);
    sleep_.wake(slot / layout::kBrickSlots);
    if (stylus >= layout::kMaxStyluses) continue;
    const Vector3f given = lattice_.strengths.mass[slot] * dv;
    layout::vec4& sum = lattice_.tools.impulses[stylus * lattice_.slotCount() + slot];
    sum = {sum.x + given.x(), sum.y + given.y(), sum.z + given.z(), sum.w + 1};
    lattice_.tools.touched[slot / layout::kBrickSlots] = 1;
  }
}

void CpuBackend::readRuns(const std::vector<uint32_t>& runs, RunPlanes& u_m, RunPlanes& v_m_per_s) const {
  const float* const u = lattice_.state.displacement[lattice_.state.current].data();
  const float* const v = lattice_.state.velocity[lattice_.state.current].data();
  for (size_t a = 0; a < 3; ++a) {
    for (size_t i = 0; i < runs.size(); ++i) {
      const size_t from = vectorAt(runs[i]) + a * layout::kBrickSlots, to = i * kRunSlots;
      std::copy_n(u + from, kRunSlots, &u_m[a][to]);
      std::copy_n(v + from, kRunSlots, &v_m_per_s[a][to]);
    }
  }
}

void CpuBackend::pushRuns(uint32_t stylus, float dt_s, const std::vector<uint32_t>& runs, const RunPlanes& dv_m_per_s) {
  pushed_[stylus].resize(3 * lattice_.slotCount(), 0);
  pushed_bricks_.assign(bricks(), 0);
  viscera::pushRuns({runs.data(),
                     runs.size(),
                     {dv_m_per_s[0].data(), dv_m_per_s[1].data(), dv_m_per_s[2].data()},
                     dt_s,
                     lattice_.strengths.mobility.data(),
                     lattice_.strengths.mass.data(),
                     lattice_.state.velocity[lattice_.state.current].data(),
                     lattice_.state.displacement[lattice_.state.current].data(),
                     pushed_[stylus].data(),
                     pushed_bricks_.data()});
  for (uint32_t brick = 0; brick < pushed_bricks_.size(); ++brick) {
    if (!pushed_bricks_[brick]) continue;
    lattice_.tools.touched[brick] = 1;
    sleep_.wake(brick);
  }
}

/// Adds the impulses of blades to those of styluses.
void CpuBackend::sumPushes() {
  for (size_t s = 0; s < pushed_.size(); ++s) {
    for (const uint32_t slot : lattice_.store.active) {
      if (pushed_[s].empty() || !lattice_.tools.touched[slot / layout::kBrickSlots]) continue;
      const Vector3f given = planesAt(pushed_[s].data(), slot);
      if (given.isZero(0)) continue;
      layout::vec4& sum = lattice_.tools.impulses[s * lattice_.slotCount() + slot];
      sum = {sum.x + given.x(), sum.y + given.y(), sum.z + given.z(), sum.w + 1};
      setPlanes(pushed_[s].data(), slot, Vector3f::Zero());
    }
  }
}

}  // namespace viscera
