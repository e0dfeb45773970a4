// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "solver/processes/port.h"

namespace viscera {

namespace {

std::vector<uint32_t> slotsOf(const std::vector<uint32_t>& runs) {
  std::vector<uint32_t> out;
  for (const uint32_t first : runs) {
    for (uint32_t k = 0; k < kRunSlots; ++k) out.push_back(first + k);
  }
  return out;
}

}  // namespace

void TissuePort::readRuns(const std::vector<uint32_t>& runs, RunPlanes& u_m, RunPlanes& v_m_per_s) const {
  const std::vector<uint32_t> slots = slotsOf(runs);
  std::vector<Vector3f> u(slots.size()), v(slots.size());
  readNodes(slots, u, v);
  for (int a = 0; a < 3; ++a) {
    for (size_t i = 0; i < slots.size(); ++i) {
      u_m[static_cast<size_t>(a)][i] = u[i][a];
      v_m_per_s[static_cast<size_t>(a)][i] = v[i][a];
    }
  }
}

void TissuePort::pushRuns(uint32_t stylus, float dt_s, const std::vector<uint32_t>& runs, const RunPlanes& dv_m_per_s) {
  std::vector<Vector3f> dv(runs.size() * kRunSlots);
  for (size_t i = 0; i < dv.size(); ++i) dv[i] = {dv_m_per_s[0][i], dv_m_per_s[1][i], dv_m_per_s[2][i]};
  pushNodes(stylus, dt_s, slotsOf(runs), dv);
}

}  // namespace viscera
