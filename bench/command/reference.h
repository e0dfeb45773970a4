// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "cli/commands.h"

namespace viscera::bench {

struct ReferenceRunOptions {
  cli::RunOptions run;   ///< options of the run: scene, mesh, strokes, seconds and overrides are used
  bool compare = false;  ///< whether to compare with the GPU
};

/// Runs `viscera bench reference`: a scene in float64 on the CPU, without OpenGL unless it is compared with the GPU.
/// @return exit status
int referenceRun(const ReferenceRunOptions& options);

}  // namespace viscera::bench
