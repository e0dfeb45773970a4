// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "viscera/haptics/passivity.h"

#include <gtest/gtest.h>

#include <cmath>

namespace viscera {
namespace {

constexpr double kPeriod_s = 1e-3, kPassivityStiff_n_per_m = 500, kDepth_m = 3e-3;
constexpr double kRounding = 1e-12;  // of sums of several doubles of order 1

/// Moves a tip into a wall and out again; the wall pushes back with different shares of its force on both paths.
/// @returns the energy that the tip has received at the end [J]
double inAndOut(double share_in, double share_out, PassivityControl& control) {
  const int periods = 200;
  double depth_m = 0;
  for (int i = 1; i <= periods; ++i) {
    const double next_m = kDepth_m * std::sin(3.14159265358979 * i / periods);
    const double speed = (next_m - depth_m) / kPeriod_s;
    const double force = (speed > 0 ? share_in : share_out) * kPassivityStiff_n_per_m * next_m;
    control.moved({0, 0, depth_m - next_m}, (i - 1) * kPeriod_s, i * kPeriod_s);
    const double now_s = i * kPeriod_s;
    control.sent(control.damped({0, 0, -speed}, {0, 0, force}, 0.5 * force * next_m, now_s, now_s), now_s);
    depth_m = next_m;
  }
  return control.energy_j();
}

TEST(PassivityControl, LeavesAPassiveWallAlone) {
  PassivityControl control({kPeriod_s, 0, 1e-3});
  const double stored_j = 0.5 * kPassivityStiff_n_per_m * kDepth_m * kDepth_m;
  EXPECT_NEAR(inAndOut(1, 0.6, control), 0.4 * stored_j, 0.03 * stored_j);
}

TEST(PassivityControl, KeepsAWallFromGivingMoreThanItGot) {
  PassivityControl control({kPeriod_s, 0, 1e-3});
  inAndOut(0.3, 1, control);  // without control, it would give 0.7 of 2.25 mJ
  EXPECT_GT(control.least_j(), -2e-4);
}

TEST(PassivityControl, TurnsNoForceRound) {
  PassivityControl control({kPeriod_s, 0, 0});
  for (double speed : {0.001, 0.1, 3.0}) EXPECT_GE(control.damped({0, 0, speed}, {0, 0, 2}, 1, 0, 0).z(), 0) << speed;
}

TEST(PassivityControl, CountsTheForceThatActedARoundTripAgo) {
  PassivityControl control({kPeriod_s, 2 * kPeriod_s, 1});
  for (int i = 1; i <= 4; ++i) control.sent({0, 0, static_cast<double>(i)}, i * kPeriod_s);
  // Between the poses of 4 ms and 5 ms, the force sent from 2 ms to 3 ms acted.
  EXPECT_NEAR(control.moved({0, 0, -0.001}, 4 * kPeriod_s, 5 * kPeriod_s)->z(), 2, kRounding);
  EXPECT_NEAR(control.energy_j(), 0.002, kRounding);
}

TEST(PassivityControl, CountsAMotionOfManyPeriodsWithTheForcesOfAllOfThem) {
  PassivityControl control({kPeriod_s, 0, 1});
  for (int i = 0; i < 10; ++i) control.sent({0, 0, static_cast<double>(i)}, i * kPeriod_s);
  EXPECT_NEAR(control.moved({0, 0, -0.001}, 0, 10 * kPeriod_s)->z(), 4.5, kRounding);
  EXPECT_NEAR(control.energy_j(), 0.0045, kRounding);
}

TEST(PassivityControl, BooksNothingBeyondWhatItRemembers) {
  PassivityControl control({kPeriod_s, 0, 1});
  const int periods = static_cast<int>(10 * PassivityControl::kLongestTransit_s / kPeriod_s);
  for (int i = 0; i < periods; ++i) control.sent({0, 0, 1}, i * kPeriod_s);
  EXPECT_FALSE(control.moved({0, 0, 0.03}, 0, periods * kPeriod_s));
  EXPECT_EQ(control.energy_j(), 0);
  EXPECT_TRUE(control.moved({0, 0, 0.03}, (periods - 50) * kPeriod_s, periods * kPeriod_s));
}

}  // namespace
}  // namespace viscera
