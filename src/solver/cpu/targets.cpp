// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include <hwy/highway.h>

#include "solver/cpu/kernels.h"

namespace viscera::simd {

namespace {

void choose(int64_t target) {
  hwy::SetSupportedTargetsForTest(target);  // 0: what the processor has
  hwy::GetChosenTarget().Update(hwy::SupportedTargets());
}

}  // namespace

std::vector<std::string> targets() {
  std::vector<std::string> out;
  for (int64_t target : hwy::SupportedAndGeneratedTargets()) out.push_back(hwy::TargetName(target));
  return out;
}

bool useTarget(const std::string& name) {
  choose(0);
  if (name.empty()) return true;
  for (int64_t target : hwy::SupportedAndGeneratedTargets()) {
    if (name != hwy::TargetName(target)) continue;
    choose(target);
    return true;
  }
  return false;
}

}  // namespace viscera::simd
