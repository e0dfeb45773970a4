// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
// What blades that tissue resists, threads and needles see and change of the nodes.
#include <algorithm>
#include <cmath>

#include "solver/cpu/cpu_backend.h"

namespace viscera {

namespace {

/// A run of nodes along one axis. @returns whether any is pushed
bool pushRun(const float* __restrict dv_m_per_s, float dt_s, const float* __restrict mobility,
             const float* __restrict mass_kg, float* __restrict v, float* __restrict u, float* __restrict pushed) {
  float any = 0;
  for (size_t k = 0; k < BladeNodes::kLanes; ++k) {
    const float dv = mobility[k] == 0 ? 0.0f : dv_m_per_s[k];
    any += std::abs(dv);
    v[k] += dv;
    u[k] += dt_s * dv;
    pushed[k] += mass_kg[k] * dv;
  }
  return !(any == 0);
}

}  // namespace

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
    layout::vec4& sum = lattice_.hands.impulses[stylus * lattice_.slotCount() + slot];
    sum = {sum.x + given.x(), sum.y + given.y(), sum.z + given.z(), sum.w + 1};
    lattice_.hands.touched[slot / layout::kBrickSlots] = 1;
  }
}

void CpuBackend::readRuns(const std::vector<uint32_t>& runs, BladeNodes::Planes& u_m,
                          BladeNodes::Planes& v_m_per_s) const {
  const float* const u = lattice_.state.displacement[lattice_.state.current].data();
  const float* const v = lattice_.state.velocity[lattice_.state.current].data();
  for (size_t a = 0; a < 3; ++a) {
    for (size_t i = 0; i < runs.size(); ++i) {
      const size_t from = vectorAt(runs[i]) + a * layout::kBrickSlots, to = i * BladeNodes::kLanes;
      std::copy_n(u + from, BladeNodes::kLanes, &u_m[a][to]);
      std::copy_n(v + from, BladeNodes::kLanes, &v_m_per_s[a][to]);
    }
  }
}

void CpuBackend::pushRuns(uint32_t stylus, float dt_s, const std::vector<uint32_t>& runs,
                          const BladeNodes::Planes& dv_m_per_s) {
  pushed_[stylus].resize(3 * lattice_.slotCount(), 0);
  for (size_t i = 0; i < runs.size(); ++i) {
    const size_t slot = runs[i];
    bool any = false;
    for (size_t a = 0; a < 3; ++a) {
      const size_t at = vectorAt(runs[i]) + a * layout::kBrickSlots;
      any |= pushRun(&dv_m_per_s[a][i * BladeNodes::kLanes], dt_s, &lattice_.strengths.mobility[slot],
                     &lattice_.strengths.mass[slot], &lattice_.state.velocity[lattice_.state.current][at],
                     &lattice_.state.displacement[lattice_.state.current][at], &pushed_[stylus][at]);
    }
    if (!any) continue;
    lattice_.hands.touched[slot / layout::kBrickSlots] = 1;
    sleep_.wake(static_cast<uint32_t>(slot / layout::kBrickSlots));
  }
}

/// What blades gave goes to the impulses of styluses.
void CpuBackend::sumPushes() {
  for (size_t s = 0; s < pushed_.size(); ++s) {
    for (const uint32_t slot : lattice_.store.active) {
      if (pushed_[s].empty() || !lattice_.hands.touched[slot / layout::kBrickSlots]) continue;
      const Vector3f given = planesAt(pushed_[s].data(), slot);
      if (given.isZero(0)) continue;
      layout::vec4& sum = lattice_.hands.impulses[s * lattice_.slotCount() + slot];
      sum = {sum.x + given.x(), sum.y + given.y(), sum.z + given.z(), sum.w + 1};
      setPlanes(pushed_[s].data(), slot, Vector3f::Zero());
    }
  }
}

}  // namespace viscera
