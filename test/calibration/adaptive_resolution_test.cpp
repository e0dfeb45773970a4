// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "calibration/adaptive_resolution.h"

#include <gtest/gtest.h>

#include <cmath>

#include "session/block_session.h"
#include "support/text.h"
#include "viscera/math/error.h"
#include "viscera/model/body/spacing_choice.h"

namespace viscera {
namespace {

using namespace test;

constexpr double kSpacing_m = 0.005, kFactor = 0.6;

Scene automatic() {
  Scene scene = blockScene();
  scene.bodies[0].auto_spacing = true;
  return scene;
}

Scene chosen(double spacing_m) {
  Scene scene = blockScene();
  scene.bodies[0].spacing_m = spacing_m;
  return scene;
}

/// Returns all messages.
std::string run(AdaptiveResolution& adaptive_resolution, double factor, int seconds = AdaptiveResolution::kReadings,
                uint64_t tick = 1) {
  std::string said;
  for (int s = 0; s < seconds; ++s) said += adaptive_resolution.record(factor, tick);
  return said;
}

TEST(AdaptiveResolution, SaysOnceWhatSpacingWouldKeepUp) {
  AdaptiveResolution adaptive_resolution;
  adaptive_resolution.begin(automatic(), chosen(kSpacing_m));
  EXPECT_EQ(run(adaptive_resolution, kFactor, AdaptiveResolution::kReadings - 1), "");
  EXPECT_TRUE(says(adaptive_resolution.record(kFactor, 1), {"5 mm is too fine", "service coarsen"}));
  EXPECT_EQ(run(adaptive_resolution, kFactor), "");
  EXPECT_EQ(run(adaptive_resolution, 1), "");
  EXPECT_NE(run(adaptive_resolution, kFactor), "");  // it was fast enough in between
}

TEST(AdaptiveResolution, SaysSoAgainAfterAReset) {
  AdaptiveResolution adaptive_resolution;
  adaptive_resolution.begin(automatic(), chosen(kSpacing_m));
  EXPECT_NE(run(adaptive_resolution, kFactor, AdaptiveResolution::kReadings, 700), "");
  EXPECT_EQ(run(adaptive_resolution, kFactor, AdaptiveResolution::kReadings, 800), "");
  EXPECT_NE(run(adaptive_resolution, kFactor, 1, 40), "");
}

TEST(AdaptiveResolution, TakesALatticeOfWhichASecondTakesSoMuchLess) {
  AdaptiveResolution adaptive_resolution;
  const Scene asked = automatic();
  adaptive_resolution.begin(asked, chosen(kSpacing_m));
  run(adaptive_resolution, kFactor);
  const Scene coarser = adaptive_resolution.coarser(asked);
  const double wanted = asked.solver.real_time_factor / kFactor;
  EXPECT_NEAR(std::pow(coarser.bodies[0].spacing_m / kSpacing_m, 4), wanted, 1e-9 * wanted);
  EXPECT_FALSE(coarser.bodies[0].auto_spacing);
  EXPECT_TRUE(says(coarser.bodies[0].spacing_note, {"instead of 5 mm"}));
  adaptive_resolution.begin(coarser, coarser);  // coarser once more
  run(adaptive_resolution, kFactor);
  EXPECT_GT(adaptive_resolution.coarser(coarser).bodies[0].spacing_m, coarser.bodies[0].spacing_m);
}

TEST(AdaptiveResolution, LeavesWhatKeepsUpOrWasNotAskedFor) {
  const auto refused = [](const Scene& asked, double factor, int seconds) {
    AdaptiveResolution adaptive_resolution;
    adaptive_resolution.begin(asked, chosen(kSpacing_m));
    run(adaptive_resolution, factor, seconds);
    return messageOf<Error>([&] { (void)adaptive_resolution.coarser(asked); });
  };
  EXPECT_TRUE(says(refused(automatic(), 1, 10), {"runs in real time: 1 of real time"}));
  EXPECT_TRUE(says(refused(automatic(), kFactor, 3), {"has not run for 5 s"}));
  EXPECT_TRUE(says(refused(chosen(kSpacing_m), kFactor, 10), {"no body of the scene has spacing_m: auto"}));
  EXPECT_EQ(refused(automatic(), kFactor, 10), "nothing was thrown");
}

}  // namespace
}  // namespace viscera
