// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <cmath>

#include "bench/harness/experiment.h"
#include "support/process.h"
#include "support/source_folder.h"
#include "support/text.h"

namespace viscera::bench {
namespace {

Model cube() {
  return blockModel({1, 1, 1}, 1, unitMaterial());
}

Track trackOf(const Model& model, double u_m) {
  Track track;
  track.u_m.assign(1, Field(model.slots(), Vector3d(u_m, 0, 0)));
  return track;
}

TEST(Misfit, IsTheErrorOverTheLargestDisplacementOfTheTruth) {
  const Model model = cube();
  const Track truth = trackOf(model, 2);
  Track track = truth;
  track.u_m[0][model.bodies[0].lattice.active_slots[3]].y() = 1;  // one of eight nodes is off by half of it
  EXPECT_DOUBLE_EQ(misfit(model, track, truth).max, 0.5);
  EXPECT_DOUBLE_EQ(misfit(model, track, truth).rms, 0.5 / std::sqrt(8.0));
}

TEST(Misfit, KeepsWhatIsNotANumber) {
  const Model model = cube();
  const Track truth = trackOf(model, 2);
  Track track = truth;
  track.u_m[0][model.bodies[0].lattice.active_slots[0]].y() = std::nan("");
  EXPECT_TRUE(std::isnan(misfit(model, track, truth).max));
  EXPECT_TRUE(std::isnan(misfit(model, track, truth).rms));
}

TEST(Extrapolation, RemovesTheErrorOfItsOrder) {
  const Model model = cube();
  const uint32_t slot = model.bodies[0].lattice.active_slots[0];
  constexpr double kTruth = 3, kError = 0.01;  // of the fine track
  EXPECT_DOUBLE_EQ(
      extrapolated(trackOf(model, kTruth + 4 * kError), trackOf(model, kTruth + kError), 2).u_m[0][slot].x(), kTruth);
  EXPECT_DOUBLE_EQ(
      extrapolated(trackOf(model, kTruth + 2 * kError), trackOf(model, kTruth + kError), 1).u_m[0][slot].x(), kTruth);
}

#ifdef VISCERA_HAS_COMMAND
void expectAccuracyLimits(const std::string& backend) {
  const test::TemporaryFolder folder;
  const test::Ending ending = test::runProgram(
      kCommand, {"bench", "accuracy", "--short", "--strict", "--backend", backend, "--out", folder.path()});
  EXPECT_EQ(ending.status, 0) << ending.out << ending.err;
  EXPECT_TRUE(test::says(ending.out, {"Order", "float32 against float64", "Cantilever", "Heart", ", 0 missed"}));
  for (const char* table : {"order", "float32", "momentum", "energy", "cantilever", "shell", "heart", "spacing_heart",
                            "spacing_ball", "checks"}) {
    const std::string file = std::string("accuracy_") + table + ".csv", text = test::readFile(folder.file(file));
    EXPECT_TRUE(test::says(text, {backend})) << file << ":\n" << text;
  }
}

TEST(AccuracySuite, ReachesEveryLimitInItsShortForm) {
  expectAccuracyLimits("cpu");
}

TEST(AccuracySuite, ReachesEveryLimitOnTheGpu) {
  expectAccuracyLimits("gpu");
}
#endif  // VISCERA_HAS_COMMAND

}  // namespace
}  // namespace viscera::bench
