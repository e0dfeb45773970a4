// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
// Bodies grown together, on the GPU backend (docs/physics.md 17).
#include "solver/cpu/cpu_solver.h"
#include "solver/processes/attach/attached_blocks.h"
#include "support/gpu_fixture.h"

namespace viscera {
namespace {

using namespace test;

constexpr double kAsOnTheCpu = 1e-3;  // of a work: the backends round differently in some 100 substeps

class AttachmentsOnGpu : public GpuTest {};

TEST_F(AttachmentsOnGpu, ActAsOnTheReference) {
  const Scene scene = loadedBlocks("gpu");
  const Model model = buildModel(scene);
  GpuSolver solver(model, scene);
  expectToMoveAsTheReference(model, scene, solver, 4);
}

TEST_F(AttachmentsOnGpu, TearAsOnTheCpu) {
  Scene scene = loadedBlocks("gpu");
  scene.environment.gravity_m_per_s2 = {0, 0, 60};
  const Model model = buildModel(scene);
  CpuSolver cpu(model, scene);
  GpuSolver gpu(model, scene);
  for (int t = 0; t < 4; ++t) {
    cpu.step(ToolMotions{});
    gpu.step(ToolMotions{});
  }
  const double spent_j = factOf(cpu, "spent_j");
  EXPECT_GT(spent_j, 0);
  EXPECT_NEAR(factOf(gpu, "spent_j"), spent_j, kAsOnTheCpu * spent_j);
}

}  // namespace
}  // namespace viscera
