// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include <limits>

#include "mesh_samples.h"
#include "viscera/math/error.h"
#include "viscera/model/shape/solid.h"

namespace viscera::test {
namespace {

constexpr float kRadius = 0.05f;  // m
constexpr int kRings = 48;
const Vector3f kCenter(0.012f, -0.3f, 0.207f);

/// Returns the message of the error of voxelisation.
template <typename Expected>
std::string refusalOf(const TriangleMesh& mesh, double spacing_m) {
  try {
    voxelise(mesh, spacing_m);
  } catch (const Expected& error) {
    return error.what();
  }
  ADD_FAILURE() << "accepted";
  return "";
}

TEST(VoxeliseRefuses, SheetsWithoutInside) {
  TriangleMesh plane;
  plane.positions_m = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0.2f}, {0, 1, 0.2f}};
  plane.triangles = {{0, 1, 2}, {0, 2, 3}};
  plane.parts = {0, 0};
  plane.part_names = {"plane"};
  EXPECT_NE(refusalOf<MeshError>(plane, 0.1).find("encloses no volume"), std::string::npos);
  const TriangleMesh dish = sphereMesh(kCenter, kRadius, kRings, 3 * kRings / 4);
  EXPECT_NE(refusalOf<MeshError>(dish, 0.005).find("encloses no volume"), std::string::npos);
  TriangleMesh folded = joined(plane, turnedInsideOut(plane), true);
  for (auto& t : folded.triangles) {
    for (uint32_t& v : t) v %= 4;  // two faces on the same vertices
  }
  EXPECT_NE(refusalOf<MeshError>(folded, 0.1).find("encloses no volume"), std::string::npos);
}

TEST(VoxeliseRefuses, AGridThatDoesNotFitIsRefusedBeforeItIsMade) {
  const TriangleMesh sphere = sphereMesh(kCenter, kRadius, 8);
  const std::string message = refusalOf<LatticeError>(sphere, 1e-6);
  const size_t at = message.find("spacing_m >= ");
  ASSERT_NE(at, std::string::npos) << message;
  const double would_fit_m = std::stod(message.substr(at + 13));
  EXPECT_NO_THROW(requireGridMemory(Eigen::Array3d::Constant(2.0 * kRadius / would_fit_m), would_fit_m)) << message;
  EXPECT_THROW(voxelise(
                   [](const Vector3d&) {
                     return LabelledDistance{-1, 0};
                   },
                   {"all"}, Vector3d::Zero(), Vector3d::Ones(), 1e-6),
               LatticeError);
  EXPECT_THROW(boxSolid(Vector3d::Zero(), Vector3d::Ones(), 1e-6), LatticeError);
}

TEST(VoxeliseRefuses, SpacingMustBePositiveAndFinite) {
  for (const double bad : {0.0, -0.01, std::numeric_limits<double>::quiet_NaN(), 1 / 0.0}) {
    const std::string message = refusalOf<LatticeError>(sphereMesh(kCenter, kRadius, 8), bad);
    EXPECT_NE(message.find("spacing_m must be a finite number > 0"), std::string::npos) << message;
    EXPECT_THROW(boxSolid(Vector3d::Zero(), Vector3d::Ones(), bad), LatticeError);
  }
}

TEST(VoxeliseRefuses, TooLargeASpacingNamesOneThatDoes) {
  const TriangleMesh balloon =
      joined(sphereMesh(kCenter, kRadius, kRings), turnedInsideOut(sphereMesh(kCenter, 0.045f, kRings)), true);
  EXPECT_NE(refusalOf<LatticeError>(balloon, 1).find("larger than the whole body"), std::string::npos);
  const auto field = [](const Vector3d& p) { return LabelledDistance{std::abs(p.norm() - 0.045) - 0.005, 0}; };
  const Vector3d corner = Vector3d::Constant(0.05);
  try {
    voxelise(field, {"balloon"}, -corner, corner, 0.1);
    FAIL() << "one cell, its centre in the cavity";
  } catch (const LatticeError& error) {
    const std::string message = error.what();
    const size_t at = message.find("must be at most ");
    ASSERT_NE(at, std::string::npos) << message;
    EXPECT_GT(voxelise(field, {"balloon"}, -corner, corner, std::stod(message.substr(at + 16))).filledCells(), 0u);
  }
}

}  // namespace
}  // namespace viscera::test
