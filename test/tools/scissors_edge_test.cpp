// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tools/scissors_edge.h"

#include <gtest/gtest.h>

#include <cmath>

namespace viscera {
namespace {

constexpr Scissors kShears{0.02, 0.07};
constexpr double kWide_rad = 0.7;

TEST(ScissorsEdge, TheCrossingGoesFromThePivotToTheTipsAndStaysThere) {
  EXPECT_NEAR(crossing_m(kShears, kWide_rad), 0.02 * std::sin(0.035) / std::sin(0.35), 1e-12);
  EXPECT_NEAR(crossing_m(kShears, kShears.closed_rad), kShears.length_m, 1e-12);
  EXPECT_EQ(crossing_m(kShears, 0), crossing_m(kShears, kShears.closed_rad));
  EXPECT_EQ(crossingPerRadian_m(kShears, 0), 0);
}

TEST(ScissorsEdge, TheMomentDoesTheWorkOfTheEdge) {
  const double edge_n = 0.3, step = 1e-5;
  double work_j = 0;
  for (double opening = kWide_rad; opening > kShears.closed_rad; opening -= step)
    work_j += step * closingMoment_n_m(kShears, opening - 0.5 * step, edge_n);
  const double offset_m = kShears.length_m - crossing_m(kShears, kWide_rad);
  EXPECT_NEAR(work_j, edge_n * offset_m, 1e-3 * edge_n * offset_m);
}

TEST(ScissorsEdge, AnEdgeStandsWhereTheBladesCrossAndIsAsLongAsTheMouthWas) {
  layout::ToolMotion edge{};
  edge.from.w = 7;
  Pose pose;
  pose.position_m = {0.1, 0.2, 0.3};
  setEdge(kShears, {pose, pose, kWide_rad, 0.5 * kWide_rad, kWide_rad}, edge);
  const double before_m = crossing_m(kShears, kWide_rad), after_m = crossing_m(kShears, 0.5 * kWide_rad);
  EXPECT_NEAR(edge.from.z, 0.3 + kShears.length_m - before_m, 1e-7);
  EXPECT_NEAR(edge.to.z, 0.3 + kShears.length_m - after_m, 1e-7);
  EXPECT_NEAR(edge.from.x - edge.blade_from.x, 2 * before_m * std::tan(0.5 * kWide_rad), 1e-7);
  EXPECT_NEAR(edge.to.x - edge.blade_to.x, 2 * after_m * std::tan(0.5 * kWide_rad), 1e-7);
  EXPECT_NEAR(edge.from.y, 0.2, 1e-7);
  EXPECT_EQ(edge.from.w, 7);
}

}  // namespace
}  // namespace viscera
