// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "calibration/keep_up.h"

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

/// @returns what was said
std::string run(KeepUp& keep_up, double factor, int seconds = KeepUp::kReadings, uint64_t tick = 1) {
  std::string said;
  for (int s = 0; s < seconds; ++s) said += keep_up.note(factor, tick);
  return said;
}

TEST(KeepUp, SaysOnceWhatSpacingWouldKeepUp) {
  KeepUp keep_up;
  keep_up.begin(automatic(), chosen(kSpacing_m));
  EXPECT_EQ(run(keep_up, kFactor, KeepUp::kReadings - 1), "");
  EXPECT_TRUE(says(keep_up.note(kFactor, 1), {"5 mm is too fine", "service coarsen"}));
  EXPECT_EQ(run(keep_up, kFactor), "");
  EXPECT_EQ(run(keep_up, 1), "");
  EXPECT_NE(run(keep_up, kFactor), "");  // it had kept up in between
}

TEST(KeepUp, SaysSoAgainAfterAReset) {
  KeepUp keep_up;
  keep_up.begin(automatic(), chosen(kSpacing_m));
  EXPECT_NE(run(keep_up, kFactor, KeepUp::kReadings, 700), "");
  EXPECT_EQ(run(keep_up, kFactor, KeepUp::kReadings, 800), "");
  EXPECT_NE(run(keep_up, kFactor, 1, 40), "");
}

TEST(KeepUp, TakesALatticeOfWhichASecondTakesSoMuchLess) {
  KeepUp keep_up;
  const Scene asked = automatic();
  keep_up.begin(asked, chosen(kSpacing_m));
  run(keep_up, kFactor);
  const Scene coarser = keep_up.coarser(asked);
  const double wanted = asked.solver.real_time_factor / kFactor;
  EXPECT_NEAR(std::pow(coarser.bodies[0].spacing_m / kSpacing_m, 4), wanted, 1e-9 * wanted);
  EXPECT_FALSE(coarser.bodies[0].auto_spacing);
  EXPECT_TRUE(says(coarser.bodies[0].spacing_note, {"in place of 5 mm"}));
  keep_up.begin(coarser, coarser);  // and coarser still
  run(keep_up, kFactor);
  EXPECT_GT(keep_up.coarser(coarser).bodies[0].spacing_m, coarser.bodies[0].spacing_m);
}

TEST(KeepUp, LeavesWhatKeepsUpOrWasNotAskedFor) {
  const auto refused = [](const Scene& asked, double factor, int seconds) {
    KeepUp keep_up;
    keep_up.begin(asked, chosen(kSpacing_m));
    run(keep_up, factor, seconds);
    return messageOf<Error>([&] { (void)keep_up.coarser(asked); });
  };
  EXPECT_TRUE(says(refused(automatic(), 1, 10), {"keeps up: 1 of real time"}));
  EXPECT_TRUE(says(refused(automatic(), kFactor, 3), {"has not run for 5 s"}));
  EXPECT_TRUE(says(refused(chosen(kSpacing_m), kFactor, 10), {"no body of the scene has spacing_m: auto"}));
  EXPECT_EQ(refused(automatic(), kFactor, 10), "nothing was thrown");
}

}  // namespace
}  // namespace viscera
