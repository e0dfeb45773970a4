// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "viscera/solver/stability_monitor.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

#include "support/lattices.h"
#include "viscera/solver/material.h"

namespace viscera {
namespace {

constexpr double kTick_s = 0.01;
constexpr double kRecovery_s = 0.05;  // 5 ticks
const StabilityMonitor::Limits kLimits{10.0, 1.0};

uint32_t bits(float value) {
  uint32_t out;
  std::memcpy(&out, &value, sizeof out);
  return out;
}

layout::TickStats stats(double kinetic_j, double elastic_j, double speed = 0.1, double stretch = 0.1) {
  layout::TickStats out{};
  out.kinetic_j = static_cast<float>(kinetic_j);
  out.elastic_j = static_cast<float>(elastic_j);
  out.max_speed_bits = bits(static_cast<float>(speed));
  out.max_stretch_bits = bits(static_cast<float>(stretch));
  return out;
}

const layout::TickStats kCalm = stats(0.1, 0.1);
const layout::TickStats kExploded = stats(100, 0.1);

StabilityMonitor stability_monitor() {
  return StabilityMonitor(kLimits, kTick_s, kRecovery_s);
}

/// Returns the number of ticks until the current recovery ends.
int ticksOfRecovery(StabilityMonitor& g) {
  int ticks = 0;
  while (g.health().recovering && ticks < 1000) {
    g.judge(kCalm, true);
    ++ticks;
  }
  return ticks;
}

TEST(StabilityMonitor, OrdinaryTicksPass) {
  StabilityMonitor g = stability_monitor();
  for (int t = 0; t < 100; ++t) EXPECT_EQ(g.judge(kCalm, false), StabilityMonitor::Trip::kNone);
  EXPECT_EQ(g.health().trips, 0u);
  EXPECT_FALSE(g.health().recovering);
  EXPECT_FALSE(g.health().strained);
  EXPECT_FLOAT_EQ(g.health().elastic_j, 0.1f);
}

TEST(StabilityMonitor, NodesThatAreNotFiniteTrip) {
  StabilityMonitor g = stability_monitor();
  layout::TickStats bad = kCalm;
  bad.nonfinite = 1;
  EXPECT_EQ(g.judge(bad, true), StabilityMonitor::Trip::kNonFinite);
  EXPECT_EQ(stability_monitor().judge(stats(NAN, 0), true), StabilityMonitor::Trip::kNonFinite);
  EXPECT_EQ(stability_monitor().judge(stats(0, INFINITY), true), StabilityMonitor::Trip::kNonFinite);
}

TEST(StabilityMonitor, EnergyFromNowhereTrips) {
  StabilityMonitor g = stability_monitor();
  g.judge(kCalm, false);
  EXPECT_EQ(g.judge(stats(0.9, 1), false), StabilityMonitor::Trip::kNone);    // 1.9 < 2 (0 + 1)
  EXPECT_EQ(g.judge(stats(2, 0.7), false), StabilityMonitor::Trip::kEnergy);  // slow growth does not help
  EXPECT_EQ(g.judge(stats(2, 0.7), true), StabilityMonitor::Trip::kEnergy) << "whatever the integrator";
}

TEST(StabilityMonitor, EnergyThatToolsPutInIsAllowed) {
  StabilityMonitor g = stability_monitor();
  g.judge(kCalm, false);
  EXPECT_EQ(g.judge(stats(4, 0.7), false, 1.5), StabilityMonitor::Trip::kNone);  // 4.7 < 2 (0.2 + 1 + 1.5)
  StabilityMonitor other = stability_monitor();
  other.judge(kCalm, false);
  EXPECT_EQ(other.judge(stats(4, 0.7), false, 1), StabilityMonitor::Trip::kEnergy);
}

TEST(StabilityMonitor, EnergyOfAStateThatWasWrittenIsNoExplosion) {
  StabilityMonitor g = stability_monitor();
  g.judge(kCalm, false);
  g.restart(stats(0, 1e6));
  EXPECT_EQ(g.judge(stats(0, 1.5e6), false), StabilityMonitor::Trip::kNone);
}

TEST(StabilityMonitor, SpeedTripsExplicitIntegratorsOnly) {
  StabilityMonitor g = stability_monitor();
  EXPECT_EQ(g.judge(stats(0.1, 0.1, 11), true), StabilityMonitor::Trip::kNone);
  EXPECT_EQ(g.judge(stats(0.1, 0.1, 11), false), StabilityMonitor::Trip::kSpeed);
  EXPECT_EQ(g.health().trips, 1u);
}

TEST(StabilityMonitor, RecoveryTakesItsTimeAndEndsInACalmState) {
  StabilityMonitor g = stability_monitor();
  g.judge(kExploded, false);
  ASSERT_TRUE(g.health().recovering);
  EXPECT_EQ(ticksOfRecovery(g), 5);
  EXPECT_EQ(g.health().trips, 1u);
}

TEST(StabilityMonitor, LongSubstepsThatTripAreShortenedFirstAndForLongerEachTime) {
  const auto ticksOfShortOnes = [](StabilityMonitor& g) {
    int ticks = 0;
    for (; g.health().strained && ticks < 1000; ++ticks) g.judge(kCalm, false, 0, false);
    return ticks;
  };
  StabilityMonitor g = stability_monitor();
  g.judge(kCalm, false, 0, true);
  int expected = 5;
  for (int trip = 0; trip < 7; ++trip) {
    EXPECT_EQ(g.judge(kExploded, false, 0, true), StabilityMonitor::Trip::kEnergy);
    EXPECT_FALSE(g.health().recovering);
    EXPECT_EQ(g.setbacks(), 1);
    EXPECT_EQ(ticksOfShortOnes(g), expected) << "trip " << trip;
    expected = std::min(2 * expected, 16 * 5);
  }
  EXPECT_EQ(g.health().trips, 7u);
  for (int t = 0; t < 400; ++t) g.judge(kCalm, false, 0, true);  // a long calm period
  g.judge(kExploded, false, 0, true);
  EXPECT_EQ(ticksOfShortOnes(g), 5);
  g.judge(kExploded, false, 0, true);
  g.judge(kExploded, false, 0, false);  // the short ones trip too
  EXPECT_TRUE(g.health().recovering);
}

TEST(StabilityMonitor, RecoveryGoesOnWhileNodesAreFast) {
  StabilityMonitor g = stability_monitor();
  g.judge(kCalm, false);
  g.judge(kExploded, false);
  for (int t = 0; t < 50; ++t) g.judge(stats(0.1, 0.1, 6), true);
  EXPECT_TRUE(g.health().recovering);
  g.judge(kCalm, true);
  EXPECT_FALSE(g.health().recovering);
}

TEST(StabilityMonitor, TripsThatKeepComingMakeRecoveriesLongerUpToSixteenTimes) {
  StabilityMonitor g = stability_monitor();
  g.judge(kCalm, false);
  int expected = 5;
  for (int trip = 0; trip < 7; ++trip) {
    ASSERT_EQ(g.judge(kExploded, false), StabilityMonitor::Trip::kEnergy);
    EXPECT_EQ(ticksOfRecovery(g), expected) << "trip " << trip;
    expected = std::min(2 * expected, 16 * 5);
  }
  for (int t = 0; t < 30; ++t) g.judge(kCalm, false);  // a long calm period
  g.judge(kExploded, false);
  EXPECT_EQ(ticksOfRecovery(g), 5);
}

TEST(StabilityMonitor, SetbacksCountTripsWithoutAGoodTickBetween) {
  StabilityMonitor g = stability_monitor();
  g.judge(kCalm, false);
  g.judge(kExploded, false);
  EXPECT_EQ(g.setbacks(), 1);
  g.judge(kExploded, true);
  EXPECT_EQ(g.setbacks(), 2);
  g.judge(kCalm, true);
  EXPECT_EQ(g.setbacks(), 0);
}

TEST(StabilityMonitor, StretchSpeedAndCollapseMeanStrained) {
  const auto strained = [](const layout::TickStats& s) {
    StabilityMonitor g = stability_monitor();
    g.judge(s, false);
    return g.health().strained;
  };
  EXPECT_TRUE(strained(stats(0.1, 0.1, 0.1, 1.5)));
  EXPECT_TRUE(strained(stats(0.1, 0.1, 3)));
  layout::TickStats collapsed = kCalm;
  collapsed.collapsed = 1;
  EXPECT_TRUE(strained(collapsed));
}

TEST(StabilityMonitor, LimitsComeFromTheMaterial) {
  const Model model = test::modelOf({test::boxBody({2, 3, 4}, 0.01)});
  const double wave = waveSpeed(model), mass = 1060 * 24 * 1e-6;
  const StabilityMonitor::Limits still = stabilityLimits(model, 0, 1);
  EXPECT_NEAR(still.speed_m_per_s, 5 * wave, 1e-6 * wave);
  EXPECT_NEAR(still.energy_j, mass * wave * wave, 1e-5 * mass * wave * wave);  // float32 mass of a cell
  const StabilityMonitor::Limits falling = stabilityLimits(model, 9.81, 10);
  EXPECT_NEAR(falling.speed_m_per_s, 5 * std::sqrt(2 * 9.81 * 10), 1e-6);
}

}  // namespace
}  // namespace viscera
