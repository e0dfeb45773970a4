// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
// Metrics of tools, compared with values that other programs gave for the same motion.
#include "tools/tool_metrics.h"

#include <gtest/gtest.h>

#include <cmath>

namespace viscera {
namespace {

constexpr double kRate_hz = 100;
constexpr double kFiveDigits = 5e-6;

/// Returns exp(-5 t^2), t from -1 to 1, without 1.
std::vector<double> bell() {
  std::vector<double> speeds;
  for (int i = -100; i < 100; ++i) speeds.push_back(std::exp(-5 * (i / kRate_hz) * (i / kRate_hz)));
  return speeds;
}

TEST(ToolMetrics, SpectralArcLengthIsThatOfItsAuthors) {
  EXPECT_NEAR(spectralArcLength(bell(), kRate_hz), -1.41403, kFiveDigits);
}

TEST(ToolMetrics, JerkIsThatOfItsAuthors) {
  EXPECT_NEAR(dimensionlessJerk(bell(), kRate_hz), -335.74684, kFiveDigits);
  EXPECT_NEAR(logDimensionlessJerk(bell(), kRate_hz), -5.81636, kFiveDigits);
}

TEST(ToolMetrics, SmoothnessDoesNotDependOnHowFastOrFar) {
  std::vector<double> larger = bell();
  for (double& speed : larger) speed *= 7;
  EXPECT_NEAR(spectralArcLength(larger, kRate_hz), spectralArcLength(bell(), kRate_hz), 1e-12);
  EXPECT_NEAR(dimensionlessJerk(larger, kRate_hz), dimensionlessJerk(bell(), kRate_hz), 1e-9);
}

TEST(ToolMetrics, TwoStrokesAreLessSmoothThanOne) {
  std::vector<double> twice = bell();
  for (const double speed : bell()) twice.push_back(speed);
  EXPECT_LT(spectralArcLength(twice, kRate_hz), spectralArcLength(bell(), kRate_hz));
  EXPECT_LT(logDimensionlessJerk(twice, kRate_hz), logDimensionlessJerk(bell(), kRate_hz));
}

TEST(ToolMetrics, WaysAndForcesAreMeasuredWhereTheyAre) {
  ToolTrack track;
  track.rate_hz = 10;
  // Three sides of a square of 1 cm, then lost for a moment, then elsewhere: the gap adds no path.
  const Vector3d positions[] = {{0, 0, 0}, {0.01, 0, 0}, {0.01, 0.01, 0}, {0, 0.01, 0}, {5, 5, 5}, {0.5, 0.01, 0}};
  for (const Vector3d& position : positions) {
    track.positions_m.push_back(position);
    track.tracked.push_back(position.z() == 0);
    track.forces_n.push_back(Vector3d::Zero());
  }
  track.forces_n[1] = {3, 0, 4};
  track.forces_n[2] = {0, 0, 1};
  const ToolMetrics metrics = metricsOf(track);
  EXPECT_DOUBLE_EQ(metrics.time_s, 0.5);
  EXPECT_NEAR(metrics.path_m, 0.03, 1e-15);
  EXPECT_NEAR(metrics.economy, std::hypot(0.5, 0.01) / 0.03, 1e-12);
  EXPECT_DOUBLE_EQ(metrics.peak_force_n, 5);
  EXPECT_DOUBLE_EQ(metrics.mean_force_n, 3);
  EXPECT_DOUBLE_EQ(metrics.force_time_ns, 0.6);
  EXPECT_NEAR(metrics.force_volume_n3, 0, 1e-9) << "two forces lie on a line";
}

/// Corners of a box: deviations of 1, 2 and 3 N along its axes.
TEST(ToolMetrics, VolumeOfForceIsThatOfItsEllipsoid) {
  ToolTrack track;
  track.rate_hz = 10;
  for (int corner = 0; corner < 8; ++corner) {
    track.forces_n.emplace_back(10 + (corner & 1 ? 1 : -1), corner & 2 ? 2 : -2, corner & 4 ? 3 : -3);
    track.positions_m.push_back(Vector3d::Zero());
    track.tracked.push_back(true);
  }
  EXPECT_NEAR(metricsOf(track).force_volume_n3, 4.0 / 3.0 * 3.14159265358979 * 6, 1e-9);
}

TEST(ToolMetrics, OfNothingAreNothing) {
  const ToolMetrics none = metricsOf({100, {}, {}, {}}),
                    still = metricsOf({100, {true, true}, {Vector3d::Zero(), Vector3d::Zero()}, {}});
  for (const ToolMetrics& metrics : {none, still}) {
    EXPECT_EQ(metrics.path_m, 0);
    EXPECT_EQ(metrics.economy, 0);
    EXPECT_EQ(metrics.sparc, 0);
    EXPECT_EQ(metrics.log_jerk, 0);
    EXPECT_EQ(metrics.peak_force_n, 0);
  }
}

}  // namespace
}  // namespace viscera
