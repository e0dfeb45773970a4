// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "bench/harness/specimens/backends.h"

#include "solver/cpu/cpu_solver.h"
#include "solver/gpu/gpu_solver.h"
#include "viscera/math/error.h"
#include "viscera/model/scene/scene.h"

namespace viscera::bench {

std::string nameOf(Backend backend) {
  return backend == Backend::kCpu ? "cpu" : "gpu";
}

std::unique_ptr<TissueStepper> solverOn(Backend backend, const Model& model, const Scene& scene, bool allow_unstable) {
  if (backend == Backend::kCpu) {
    CpuSolverOptions options;
    options.allow_unstable = allow_unstable;
    return std::make_unique<CpuSolver>(model, scene, options);
  }
  GpuSolverOptions options;
  options.allow_unstable = allow_unstable;
  return std::make_unique<GpuSolver>(model, scene, options);
}

Machine machineFor(const std::string& asked, int device) {
  Machine out;
  if (asked != "gpu") out.backends.push_back(Backend::kCpu);
  const std::string cpu = asked == "gpu" ? "" : "cpu (" + simdTargets().front() + ")";
  if (asked == "cpu") {
    out.note = cpu;
    return out;
  }
  try {
    out.context = std::make_unique<gpu::Context>(device);
  } catch (const GpuError& error) {
    if (asked == "gpu") throw;
    out.note = cpu + " only, because there is no OpenGL context: " + error.what();
    return out;
  }
  out.backends.push_back(Backend::kGpu);
  out.note = (cpu.empty() ? "" : cpu + " and ") + "gpu (" + out.context->renderer() + ")";
  return out;
}

}  // namespace viscera::bench
