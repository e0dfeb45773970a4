// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
// The law of docs/physics.md 10 in a block; `viscera bench blade` measures more of it.
#include "bench/suites/blade/blade_trial.h"
#include "bench/suites/blade/tear_trial.h"

#include <gtest/gtest.h>

namespace viscera::bench {
namespace {

constexpr double kForce = 0.05;  // share of J w: the limit of the issue
constexpr double kRipple = 0.1;  // share of J w
constexpr double kWork = 0.02;   // share of the work that is not cutting, elastic, kinetic or damping
constexpr double kLeastDet = 0.1;
constexpr double kTear = 0.15;  // share of the toughness: the documented limit

BladeTrial trialOf(double spacing_m, double young_modulus_pa, double toughness_j_per_m2) {
  BladeTrial trial;
  trial.spacing_m = spacing_m;
  trial.young_modulus_pa = young_modulus_pa;
  trial.toughness_j_per_m2 = toughness_j_per_m2;
  return trial;
}

void expectLaw(const BladeTrial& trial) {
  const BladeResult result = cutThrough(trial);
  const double push = 1 / (1 + trial.slicing * trial.slicing);
  EXPECT_NEAR(result.force / push, 1, kForce);
  EXPECT_NEAR(result.along, trial.slicing * push, kForce);
  EXPECT_LT(result.ripple * result.force, kRipple);
  EXPECT_GT(result.worst_det, kLeastDet);
  EXPECT_EQ(result.trips, 0);
  EXPECT_NEAR(result.cut_share + result.stored_share + result.damped_share, 1, kWork);
}

TEST(BladeSuite, WorkIsToughnessTimesAreaWhateverTheSpacing) {
  expectLaw(trialOf(0.004, 20e3, 100));
  expectLaw(trialOf(0.003, 20e3, 100));
}

TEST(BladeSuite, SoItIsOfSprings) {
  BladeTrial trial = trialOf(0.004, 50e3, 200);
  trial.law = Law::kSprings;
  expectLaw(trial);
}

TEST(BladeSuite, WorkDoesNotDependOnTheDirection) {
  BladeTrial trial = trialOf(0.004, 20e3, 200);  // J / (E h) = 2.5, the largest supported value
  for (const double angle_deg : {20.0, 45.0}) {
    trial.angle_deg = angle_deg;
    expectLaw(trial);
  }
}

TEST(BladeSuite, DrawnBladesNeedLessPush) {
  BladeTrial trial = trialOf(0.004, 20e3, 100);
  for (const double slicing : {0.5, 1.0, 2.0}) {
    trial.slicing = slicing;
    expectLaw(trial);
  }
}

TEST(BladeSuite, OfToughnessThatTheLatticeCannotCarryThereIsAsMuchAsItCan) {
  const BladeTrial trial = trialOf(0.004, 5e3, 200);
  const BladeResult result = cutThrough(trial);
  EXPECT_NEAR(result.force, 1, kForce);
  EXPECT_NEAR(result.asked, 0.25, 0.25 * kForce);
  EXPECT_GT(result.worst_det, kLeastDet);
}

TEST(BladeSuite, TearsTakeTheirToughness) {
  TearTrial trial;
  trial.spacing_m = 0.004;
  const StripResult strip = pullStrip(trial);
  EXPECT_NEAR(strip.release, 1, kTear);
  EXPECT_EQ(strip.crumbs, 0u);
  const TrouserResult trousers = pullTrousers(trial);
  EXPECT_NEAR(trousers.force, 1, kTear);
  EXPECT_EQ(trousers.crumbs, 0u);
  EXPECT_EQ(trousers.trips, 0);
}

}  // namespace
}  // namespace viscera::bench
