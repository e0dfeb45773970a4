// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "solver/ticks/ticks.h"
#include "viscera/gpu/context.h"
#include "viscera/model/scene/solver_kinds.h"

namespace viscera {
struct Scene;
}

namespace viscera::bench {

/// "cpu" or "gpu".
std::string nameOf(Backend backend);

/// Ticks on one backend; the GPU's needs a current context.
/// @param model  must outlive the solver   @param allow_unstable  substeps above the stable one are taken as they are
/// @throws GpuError  shaders, memory;  SceneError  substeps, parts
std::unique_ptr<Ticks> solverOn(Backend backend, const Model& model, const Scene& scene, bool allow_unstable = false);

/// The backends that a run takes, and what the GPU's needs.
struct Machine {
  std::unique_ptr<gpu::Context> context;  ///< null: no GPU backend in the run
  std::vector<Backend> backends;          ///< kCpu, kGpu
  std::string note;                       ///< one line for a person: on what
};

/// @param asked  "cpu": no context is made; "gpu"; "both": the CPU alone where there is no EGL device
/// @param device  EGL device, or -1: the best   @throws GpuError  "gpu", and there is none
Machine machineFor(const std::string& asked, int device);

}  // namespace viscera::bench
