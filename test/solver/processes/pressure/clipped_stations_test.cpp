// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
// Which clips close a lumen (docs/physics.md 18).
#include "solver/processes/pressure/clipped_stations.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace viscera {
namespace {

constexpr double kLumen_m = 0.003, kTube_m = 0.004, kDegree = 3.14159265358979323846 / 180;

/// A lumen along x, of stations of one radius.
LumenNetwork straightLumen() {
  LumenNetwork out;
  for (int i = -8; i <= 8; ++i)
    out.stations.push_back(
        {i * kLumen_m * Vector3d::UnitX(), Vector3d::UnitX(), kLumen_m, 180 * kDegree * kLumen_m * kLumen_m, 0, 0});
  return out;
}

/// Returns what a clip holds with legs that run from one part of the width of a tube to another one.
/// @param from, to  on the legs, of the tube's radius   @param askew_deg  angle of the legs to a cross-section
/// @param side  1 or -1: direction in which it squeezes, along z
std::vector<Clips::Squeezed> clip(double from, double to, double askew_deg, double at_m, uint32_t body = 0,
                                  double side = 1, uint32_t number = 0) {
  constexpr double kStep = 0.1;
  const Vector3d leg(std::sin(askew_deg * kDegree), std::cos(askew_deg * kDegree), 0);
  std::vector<Clips::Squeezed> out;
  for (double share = from; share <= to + 1e-9; share += kStep) {
    const double y_m = share * kTube_m;
    const double half_m = std::sqrt(std::max(0.0, kTube_m * kTube_m - y_m * y_m));
    const Vector3d middle = at_m * Vector3d::UnitX() + y_m / leg.y() * leg, half = side * half_m * Vector3d::UnitZ();
    out.push_back({number, {body, body}, {middle - half, middle + half}});
  }
  return out;
}

bool closes(const std::vector<Clips::Squeezed>& squeezed) {
  const std::vector<uint8_t> closed = clippedStations(straightLumen(), 0, squeezed);
  return std::any_of(closed.begin(), closed.end(), [](uint8_t it) { return it != 0; });
}

TEST(ClippedStations, AreThoseOfAClipAtAnyAngleAndPlace) {
  for (const double askew_deg : {0, 5, 10, 30, 45}) {
    for (int i = 0; i < 20; ++i) {
      const double at_m = i * kLumen_m / 20;
      EXPECT_TRUE(closes(clip(-0.8, 0.8, askew_deg, at_m))) << askew_deg << " degrees, at " << at_m;
      EXPECT_FALSE(closes(clip(-0.2, 0.8, askew_deg, at_m))) << askew_deg << " degrees, at " << at_m;
    }
  }
}

TEST(ClippedStations, AreNotThoseOfTwoClipsOnOneSide) {
  std::vector<Clips::Squeezed> both = clip(0.1, 0.8, 0, 0, 0, 1, 0);
  const std::vector<Clips::Squeezed> opposite = clip(0.1, 0.8, 0, 0, 0, -1, 1);
  both.insert(both.end(), opposite.begin(), opposite.end());
  EXPECT_FALSE(closes(both));
}

TEST(ClippedStations, AreNotThoseOfAClipOnAnotherBody) {
  EXPECT_FALSE(closes(clip(-0.8, 0.8, 0, 0, 1)));
}

}  // namespace
}  // namespace viscera
