// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "solver/cpu/simd/targets.h"

namespace viscera::simd {

std::vector<std::string> targets() {
  std::vector<std::string> out;
  for (int64_t target : hwy::SupportedAndGeneratedTargets()) out.push_back(hwy::TargetName(target));
  return out;
}

std::optional<Kernels> kernelsFor(const std::string& target) {
  for (const int64_t each : hwy::SupportedAndGeneratedTargets()) {
    const std::string name = hwy::TargetName(each);
    if (target.empty() || target == name)
      return Kernels{name,
                     leapfrogFor(each),
                     predictFor(each),
                     measureFor(each),
                     cellsFor(each),
                     wallsFor(each),
                     measureWallsFor(each),
                     spreadNetworkFor(each),
                     leapfrogNetworkFor(each),
                     findPositionsFor(each),
                     findSidesFor(each)};
  }
  return std::nullopt;
}

}  // namespace viscera::simd
