// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "solver/ticks/tissue_stepper.h"
#include "viscera/gpu/context.h"
#include "viscera/model/scene/solver_kinds.h"

namespace viscera {
struct Scene;
}

namespace viscera::bench {

/// Returns "cpu" or "gpu".
std::string nameOf(Backend backend);

/// Creates a solver on one backend; the GPU requires a current context.
/// @param model  must outlive the solver   @param allow_unstable  whether to accept substeps above the stable one
/// @throws GpuError  shaders, memory;  SceneError  substeps, parts
std::unique_ptr<TissueStepper> solverOn(Backend backend, const Model& model, const Scene& scene,
                                        bool allow_unstable = false);

/// The backends of a run, and the context for the GPU.
struct Machine {
  std::unique_ptr<gpu::Context> context;  ///< null: the run has no GPU backend
  std::vector<Backend> backends;          ///< kCpu, kGpu
  std::string note;                       ///< description of the hardware, one line
};

/// Selects the backends.
/// @param asked  "cpu": no context is created; "gpu"; "both": the CPU alone if there is no EGL device
/// @param device  EGL device, or -1: the best   @throws GpuError  "gpu" is requested, and there is none
Machine machineFor(const std::string& asked, int device);

}  // namespace viscera::bench
