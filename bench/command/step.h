// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "viscera/model/scene/overrides.h"

namespace viscera::bench {

struct StepOptions {
  std::vector<int> nodes;       ///< of cube and heart; empty: the default
  std::string scene;            ///< in their place; empty: none
  std::string backend = "gpu";  ///< cpu, gpu or both
  int threads = 0;              ///< of the CPU backend; 0: as many as there are processors
  int device = -1;              ///< EGL device; -1: the best
  std::string csv = "-";
  bool stages = false;  ///< of the GPU, in place of whole substeps
  Overrides overrides;
};

/// `viscera bench step`: time of a substep, or of each of its stages. @return exit status
int step(const StepOptions& options);

}  // namespace viscera::bench
