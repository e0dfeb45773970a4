// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include <random>

#include "mesh_samples.h"
#include "model/shape/solid/solid_shell.h"
#include "viscera/math/error.h"
#include "viscera/model/shape/solid.h"

namespace viscera::test {
namespace {

constexpr double kSpacing = 0.01;  // m

TEST(SolidSkin, ABoxGetsAClosedSurfaceOfItsVolumeWithinACellOfItsPlanes) {
  for (const Vector3i& cells : {Vector3i(3, 3, 3), Vector3i(5, 4, 3), Vector3i(10, 10, 10), Vector3i(20, 8, 3)}) {
    const Vector3d size = kSpacing * cells.cast<double>();
    const Solid box = boxSolid({1, 2, 3}, size, kSpacing);
    const TriangleMesh skin = extractSkin(box);
    EXPECT_EQ(openEdges(skin), 0u);
    EXPECT_NEAR(signedVolume(skin), box.volumeM3(), 0.1 * box.volumeM3()) << cells.transpose();
    for (const Vector3f& p : skin.positions_m) {
      const Vector3d beyond = (p.cast<double>() - Vector3d(1, 2, 3) - 0.5 * size).cwiseAbs() - 0.5 * size;
      EXPECT_LT(std::abs(beyond.maxCoeff()), kSpacing);
    }
  }
}

TEST(SolidSkin, RandomCellsGetAClosedSurface) {
  std::mt19937 random(11);
  for (int trial = 0; trial < 5; ++trial) {
    Solid solid = boxSolid(Vector3d::Zero(), Vector3d::Constant(12 * kSpacing), kSpacing);
    for (uint16_t& label : solid.labels) label = random() % 5 < static_cast<unsigned>(trial) ? 1 : 0;
    solid.labels[0] = 1;
    const TriangleMesh skin = extractSkin(solid);
    EXPECT_EQ(openEdges(skin), 0u);
    EXPECT_GT(signedVolume(skin), 0);
  }
}

TEST(SolidSkin, ACavityHasASurfaceOfItsOwn) {
  Solid solid = boxSolid(Vector3d::Zero(), Vector3d::Constant(9 * kSpacing), kSpacing);
  const double whole = signedVolume(extractSkin(solid));
  for (int i = 0; i < 27; ++i) solid.labels[solid.index(3 + i % 3, 3 + i / 3 % 3, 3 + i / 9)] = 0;
  const TriangleMesh skin = extractSkin(solid);
  EXPECT_EQ(openEdges(skin), 0u);
  EXPECT_NEAR(signedVolume(skin), whole * 702 / 729, 0.02 * whole);
}

TEST(SolidSkin, TrianglesCarryThePartOfTheNearestCell) {
  Solid solid = boxSolid(Vector3d::Zero(), {10 * kSpacing, 4 * kSpacing, 4 * kSpacing}, kSpacing);
  solid.part_names = {"left", "right"};
  for (size_t i = 0; i < solid.labels.size(); ++i) solid.labels[i] = i % 10 < 5 ? 1 : 2;
  const TriangleMesh skin = extractSkin(solid);
  EXPECT_EQ(skin.part_names, solid.part_names);
  for (size_t t = 0; t < skin.triangles.size(); ++t) {
    float x = 0;
    for (const uint32_t v : skin.triangles[t]) x += skin.positions_m[v].x() / 3;
    if (std::abs(x - 5 * kSpacing) < 1e-6) continue;  // right on the border
    EXPECT_EQ(skin.parts[t], x < 5 * kSpacing ? 0 : 1);
  }
}

TEST(SolidSkin, ASolidWithoutCellsHasNone) {
  Solid solid = boxSolid(Vector3d::Zero(), Vector3d::Constant(kSpacing), kSpacing);
  solid.labels[0] = 0;
  EXPECT_THROW(extractSkin(solid), LatticeError);
}

TEST(SolidSkin, ASphereFieldGetsItsSphere) {
  const auto sphere = [](const Vector3d& p) {
    return LabelledDistance{p.norm() - 0.1, static_cast<uint16_t>(p.x() < 0 ? 0 : 1)};
  };
  const Vector3d corner = Vector3d::Constant(0.1);  // samples are exactly on the surface
  const TriangleMesh skin = extractSkin(sphere, {"left", "right"}, -corner, corner, kSpacing);
  EXPECT_EQ(openEdges(skin), 0u);
  EXPECT_NEAR(signedVolume(skin), sphereVolume(0.1), 0.02 * sphereVolume(0.1));
  for (const Vector3f& p : skin.positions_m) EXPECT_NEAR(p.norm(), 0.1, 0.1 * kSpacing);
  const std::vector<Vector3f> normals = vertexNormals(skin);
  for (size_t v = 0; v < normals.size(); ++v) EXPECT_GT(normals[v].dot(skin.positions_m[v].normalized()), 0.95);
  for (size_t t = 0; t < skin.triangles.size(); ++t) {
    float x = 0;
    for (const uint32_t v : skin.triangles[t]) x += skin.positions_m[v].x();
    if (std::abs(x) < 1e-6f) continue;  // right on the border
    EXPECT_EQ(skin.parts[t], x < 0 ? 0 : 1);
  }
  EXPECT_THROW(extractSkin(sphere, {"left", "right"}, -corner, corner, -1), LatticeError);
}

TEST(SolidSkin, AHoleIsCappedAndASheetStaysOpen) {
  TriangleMesh open_box = boxMesh({0, 0, 0}, {0.1F, 0.1F, 0.1F});
  open_box.triangles.resize(10);  // two triangles of a face are missing
  open_box.parts.resize(10);
  const TriangleMesh closed = withCaps(facingOutward(open_box));
  EXPECT_EQ(openEdges(closed), 0u);
  EXPECT_EQ(closed.triangles.size(), 14u);
  EXPECT_NEAR(signedVolume(closed), 1e-3, 1e-9);
  TriangleMesh sheet = open_box;
  sheet.triangles.resize(2);
  sheet.parts.resize(2);
  EXPECT_EQ(withCaps(sheet).triangles.size(), 2u);
}

}  // namespace
}  // namespace viscera::test
