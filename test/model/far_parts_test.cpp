// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <ctime>

#include "mesh_samples.h"
#include "support/text.h"
#include "viscera/math/error.h"
#include "viscera/model/shape/solid.h"

namespace viscera::test {
namespace {

/// Rejection takes the time of reading the triangles, milliseconds. Traversing the space between parts takes minutes.
constexpr double kAtOnceS = 2;  // s of CPU time

/// Returns a cube with 0.1 m edges at the origin and one of 0.02 m with its lower corner at `where_m`.
TriangleMesh organAndBall(const Vector3f& where_m) {
  TriangleMesh mesh = boxMesh(Vector3f::Zero(), Vector3f::Constant(0.1f));
  const TriangleMesh ball = boxMesh(where_m, where_m + Vector3f::Constant(0.02f));
  const auto first = static_cast<uint32_t>(mesh.positions_m.size());
  mesh.positions_m.insert(mesh.positions_m.end(), ball.positions_m.begin(), ball.positions_m.end());
  for (const auto& t : ball.triangles) {
    mesh.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
    mesh.parts.push_back(1);
  }
  mesh.part_names = {"organ", "ball"};
  return mesh;
}

void expectRefused(const TriangleMesh& mesh, double spacing_m, const std::vector<std::string>& parts) {
  const std::clock_t start = std::clock();
  EXPECT_TRUE(says(messageOf<LatticeError>([&] { voxelise(mesh, spacing_m); }), parts));
  EXPECT_LT(static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC, kAtOnceS);
}

TEST(FarParts, BallFarAwayIsRefusedByName) {
  expectRefused(organAndBall({100, 0, 0}), 0.001, {"part 'ball'", "99.9 m", "along x", "at most 4.88 m"});
  expectRefused(organAndBall({0, 0, -100}), 0.001, {"part 'ball'", "along z"});
  expectRefused(organAndBall({100, 50, 100}), 0.002, {"part 'ball'", "99.9 m", "spacing_m 0.002"});
}

TEST(FarParts, PieceOfAPartIsSaidToBeOne) {
  TriangleMesh mesh = organAndBall({100, 0, 0});
  mesh.parts.assign(mesh.parts.size(), 0);
  mesh.part_names = {"organ"};
  expectRefused(mesh, 0.001, {"a piece of part 'organ'", "99.9 m"});
}

TEST(FarParts, WhatIsAcceptedIsFilled) {
  // The error at 1 mm names the limit: just within it the grid is made.
  const std::string message = messageOf<LatticeError>([] { voxelise(organAndBall({100, 0, 0}), 0.001); });
  const size_t at = message.find("at most ");
  ASSERT_NE(at, std::string::npos) << message;
  const float gap_m = std::stof(message.substr(at + 8));
  EXPECT_GT(voxelise(organAndBall({0.1f + 0.98f * gap_m, 0, 0}), 0.001).filledCells(), 1000000u);
  EXPECT_GT(voxelise(organAndBall({1, 0, 0}), 0.005).filledCells(), 8000u);
  EXPECT_GT(voxelise(organAndBall({100, 0, 0}), 0.01).filledCells(), 1000u) << "coarse, it is few cells";
}

TEST(FarParts, SpacingThatFillsNothingIsNotBlamedAlone) {
  expectRefused(organAndBall({100, 100, 0}), 0.7, {"spacing_m 0.7 is too large", "part 'ball'", "99.9 m"});
}

}  // namespace
}  // namespace viscera::test
