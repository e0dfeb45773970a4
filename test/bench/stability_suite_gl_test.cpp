// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include "bench/suites/stability/stability_trial.h"
#include "support/process.h"
#include "support/source_folder.h"
#include "support/text.h"
#include "viscera/gpu/context.h"

namespace viscera::bench {
namespace {

TEST(ExtremeStarts, AreEightAndDeserveTheirNames) {
  const Model model = blockModel({2, 2, 2}, 0.01, {});
  const std::vector<Start> starts = extremeStarts(model);
  ASSERT_EQ(starts.size(), 8u);
  ReferenceSolver reference(model, Vector3d::Zero(), 1);
  for (const Start& start : starts) {
    const double energy_j = energyOf(reference, start.state, 0);
    if (start.name == "mirrored") {
      EXPECT_LT(energy_j, 1e-6) << "springs do not see it";
    } else {
      EXPECT_GT(energy_j, 1e-4) << start.name;  // J; if all of it moved at c_p, it would be 0.1
    }
  }
}

class StabilityTrial : public ::testing::TestWithParam<Backend> {};

TEST_P(StabilityTrial, ExplosionWithoutGovernorIsSeen) {
  const gpu::Context context;
  const Backend backend = GetParam();
  const Model model = blockModel({3, 3, 3}, 0.005, {});
  Scene scene = sceneAt(model, Integrator::kLeapfrog, 10);
  scene.solver.stability_monitor = false;
  const Outcome wild = tryStart(backend, model, scene, extremeStarts(model)[0], 20);
  EXPECT_TRUE(!wild.finite || wild.energy_ratio > 1e6);
  scene.solver.stability_monitor = true;
  const Outcome governed = tryStart(backend, model, scene, extremeStarts(model)[0], 20);
  EXPECT_TRUE(governed.finite);
  EXPECT_GT(governed.trips, 0u);
  EXPECT_LT(governed.over_bound, 1);
}

/// Roll-backs alone would keep such starts within all bounds by never leaving them.
TEST_P(StabilityTrial, TissueOfTheLawGetsOutOfExtremeStarts) {
  constexpr int kTicks = 60;
  const gpu::Context context;
  const Model model = askewBox(4, 0.45);
  Scene scene = sceneAt(model, Integrator::kLeapfrog, 1);
  scene.solver.substeps = 0;  // chosen by measurement
  for (const Start& start : extremeStarts(model)) {
    const bool is_chosen =
        start.name == "random" || start.name == "mirrored";  // others are slow on a software renderer
    if (start.name == kCollapsed || (!is_chosen && GetParam() == Backend::kGpu)) continue;
    const Outcome outcome = tryStart(GetParam(), model, scene, start, kTicks);
    EXPECT_TRUE(outcome.finite) << start.name;
    EXPECT_LT(outcome.energy_left, kStillFolded) << start.name;
  }
}

INSTANTIATE_TEST_SUITE_P(Backends, StabilityTrial, ::testing::Values(Backend::kCpu, Backend::kGpu),
                         [](const auto& backend) { return nameOf(backend.param); });

#ifdef VISCERA_HAS_COMMAND
void expectStabilityLimits(const std::string& backend) {
  const bool on_cpu = backend == "cpu";  // without a device, so that `both` is the CPU alone and reports that
  std::vector<std::string> environment;
  if (on_cpu) environment.emplace_back("__EGL_VENDOR_LIBRARY_FILENAMES=/dev/null");
  const test::TemporaryFolder folder;
  const test::Ending ending = test::runProgram(
      kCommand,
      {"bench", "stability", "--short", "--strict", "--backend", on_cpu ? "both" : backend, "--out", folder.path()},
      environment);
  EXPECT_EQ(ending.status, 0) << ending.out << ending.err;
  EXPECT_EQ(bool(test::says(ending.out, {"only, because there is no OpenGL context"})), on_cpu);
  EXPECT_TRUE(test::says(ending.out, {"extreme starts", "effect of tools", "random cuts", "state hash", ", 0 missed"}));
  for (const char* table : {"starts", "starts_law", "fractions", "tools", "cuts", "ratios", "rest", "units", "far",
                            "sizes", "hashes", "hashes_law"}) {
    const std::string rows = test::readFile(folder.file(std::string("stability_") + table + ".csv"));
    EXPECT_TRUE(test::says(rows, {"\n" + backend + ","})) << table << ":\n" << rows;
  }
  const std::string checks = test::readFile(folder.file("stability_checks.csv"));
  EXPECT_TRUE(test::says(checks, {"\n" + backend + ": cuts", "\n" + backend + ": hashes"})) << checks;
}

TEST(StabilitySuite, ReachesEveryLimitInItsShortForm) {
  expectStabilityLimits("cpu");
}

TEST(StabilitySuite, ReachesEveryLimitOnTheGpu) {
  expectStabilityLimits("gpu");
}
#endif

}  // namespace
}  // namespace viscera::bench
