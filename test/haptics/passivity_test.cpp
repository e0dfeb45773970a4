// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "viscera/haptics/passivity.h"

#include <gtest/gtest.h>

#include <cmath>

namespace viscera {
namespace {

constexpr double kPeriod_s = 1e-3, kStiff_n_per_m = 500, kDepth_m = 3e-3;

/// A tip goes into a wall and out again; the wall pushes back with other shares of its force on the way in and out.
/// @returns the energy that it has got at the end [J]
double inAndOut(double share_in, double share_out, PassivityControl& control) {
  const int periods = 200;
  double depth_m = 0;
  for (int i = 1; i <= periods; ++i) {
    const double next_m = kDepth_m * std::sin(3.14159265358979 * i / periods);
    const double speed = (next_m - depth_m) / kPeriod_s;
    const double force = (speed > 0 ? share_in : share_out) * kStiff_n_per_m * next_m;
    control.step({0, 0, depth_m - next_m}, {0, 0, -speed}, {0, 0, force}, 0.5 * force * next_m);
    depth_m = next_m;
  }
  return control.energy_j();
}

TEST(PassivityControl, LeavesAPassiveWallAlone) {
  PassivityControl control({kPeriod_s, 0, 1e-3});
  const double stored_j = 0.5 * kStiff_n_per_m * kDepth_m * kDepth_m;
  EXPECT_NEAR(inAndOut(1, 0.6, control), 0.4 * stored_j, 0.03 * stored_j);
}

TEST(PassivityControl, KeepsAWallFromGivingMoreThanItGot) {
  PassivityControl control({kPeriod_s, 0, 1e-3});
  inAndOut(0.3, 1, control);  // left alone, it would give 0.7 of 2.25 mJ
  EXPECT_GT(control.least_j(), -2e-4);
}

TEST(PassivityControl, TurnsNoForceRound) {
  PassivityControl control({kPeriod_s, 0, 0});
  for (double speed : {0.001, 0.1, 3.0})
    EXPECT_GE(control.step({0, 0, speed * kPeriod_s}, {0, 0, speed}, {0, 0, 2}, 1).z(), 0) << speed;
}

TEST(PassivityControl, CountsTheForceThatActedARoundTripAgo) {
  PassivityControl control({kPeriod_s, 2 * kPeriod_s, 1});
  for (double force : {1.0, 2.0, 3.0, 4.0}) {
    control.step(Vector3d::Zero(), Vector3d::Zero(), {0, 0, force}, 1);
    control.sent({0, 0, force});
  }
  EXPECT_EQ(control.acting_n().z(), 2);  // of the way from the pose that was measured last: what was sent two before
  control.step({0, 0, -0.001}, Vector3d::Zero(), Vector3d::Zero(), 1);
  EXPECT_NEAR(control.energy_j(), 0.002, 1e-12);
}

}  // namespace
}  // namespace viscera
