// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "solver/cpu/cpu_solver.h"
#include "solver/gpu/gpu_solver.h"
#include "support/gpu_fixture.h"
#include "viscera/model/scene/scene.h"

namespace viscera::test {

/// Returns "gpu", then the CPU with each instruction set of this processor, best first: "cpu AVX3", "cpu SSE4" ...
inline std::vector<std::string> backendNames() {
  std::vector<std::string> out = {"gpu"};
  for (const std::string& target : simdTargets()) out.push_back("cpu " + target);
  return out;
}

/// Returns "gpu" and the CPU with its best instruction set, for tests that do not need several.
inline std::vector<std::string> backendKinds() {
  std::vector<std::string> out = backendNames();
  out.resize(2);
  return out;
}

inline std::unique_ptr<CpuSolver> makeCpu(const std::string& simd, const Model& model, Scene scene, int threads = 2,
                                          const SolverOptions& options = {}) {
  scene.solver.threads = threads;
  return std::make_unique<CpuSolver>(model, scene, CpuSolverOptions{options, simd});
}

/// Makes a backend. @param name  one of backendNames(); "gpu" needs a context   @param model  must outlive the solver
inline std::unique_ptr<TissueStepper> makeBackend(const std::string& name, const Model& model, const Scene& scene,
                                                  const SolverOptions& options = {}) {
  constexpr size_t kPrefix = 4;  // length of "cpu "
  if (name != "gpu") return makeCpu(name.substr(kPrefix), model, scene, 2, options);
  return std::make_unique<GpuSolver>(model, scene, GpuSolverOptions{options, layout::kGroupSize});
}

/// One test body for every backend; with an EGL context where it needs one.
class OnBackend : public ::testing::TestWithParam<std::string> {
 protected:
  OnBackend() {
    if (GetParam() != "gpu") return;
    context_.emplace();
    gpu::checkDispatches(true);
  }
  std::unique_ptr<TissueStepper> make(const Model& model, const Scene& scene, const SolverOptions& options = {}) const {
    return makeBackend(GetParam(), model, scene, options);
  }
  /// Returns whether the backend is a GPU in software, where a tick of a small block takes as long as one of a large.
  bool isSoftwareGpu() const { return context_ && context_->isSoftware(); }

 private:
  std::optional<gpu::Context> context_;
};

/// Returns the name of the backend as the last part of a test's name.
inline std::string backendSuffix(const ::testing::TestParamInfo<std::string>& info) {
  std::string out = info.param;
  out.erase(std::remove(out.begin(), out.end(), ' '), out.end());
  return out;
}

}  // namespace viscera::test
