// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <ctime>
#include <vector>

#include "solver/processes/suture/chain/chain.h"

namespace viscera::bench {

constexpr double kPi = 3.14159265358979323846;
constexpr double kSubstep_s = 5e-4;

/// Returns the material of a suture of radius 0.1 mm.
inline ChainMaterial nylon(double bending_share = 1) {
  constexpr double kStiffness_pa = 5e9;
  ChainMaterial out;
  out.bending_nm2 = bending_share * kStiffness_pa * kPi * std::pow(out.radius_m, 4) / 4;
  return out;
}

inline std::vector<Vector3d> straight(size_t nodes, double link_m) {
  std::vector<Vector3d> out(nodes);
  for (size_t i = 0; i < nodes; ++i) out[i] = Vector3d(static_cast<double>(i) * link_m, 0, 0);
  return out;
}

inline ChainHold holdAt(const Chain& chain, uint32_t node) {
  ChainHold out;
  out.node = node;
  out.to_m = chain.positions_m()[node];
  return out;
}

inline double cpuTime_s() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

}  // namespace viscera::bench
