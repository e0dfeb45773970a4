// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "model/shape/solid/joined_parts.h"

#include <gtest/gtest.h>

#include "model/body_samples.h"
#include "model/shape/organ/tissue.h"
#include "model/solid_probe.h"
#include "viscera/model/shape/solid.h"

namespace viscera::test {
namespace {

constexpr float kBallRadius = 0.05f;  // m
constexpr int kBallRings = 48;
constexpr double kCellOfBall = 0.004;   // m
constexpr double kJoinRounding = 1e-5;  // of a volume: files and positions have single precision

/// Returns the mesh in two parts, each with vertices of its own; `second` selects triangles by their centre.
template <class Second>
TriangleMesh split(const TriangleMesh& mesh, Second second) {
  TriangleMesh first = mesh, other = mesh;
  first.triangles.clear();
  other.triangles.clear();
  for (const auto& t : mesh.triangles) {
    const Vector3f middle = (mesh.positions_m[t[0]] + mesh.positions_m[t[1]] + mesh.positions_m[t[2]]) / 3;
    (second(middle) ? other : first).triangles.push_back(t);
  }
  first.parts.assign(first.triangles.size(), 0);
  other.parts.assign(other.triangles.size(), 0);
  first.part_names = {"first"};
  other.part_names = {"second"};
  return joined(first, other, false);
}

TriangleMesh ball() {
  return sphereMesh(Vector3f::Zero(), kBallRadius, kBallRings);
}

double volumeOf(const TriangleMesh& mesh, double spacing_m = kCellOfBall) {
  return voxeliseByMoments(mesh, spacing_m).volumeM3();
}

double volumeOf(const BodyConfig& config) {
  return makeTissue(config, "")->fill(config.spacing_m, {}).solid.volumeM3();
}

TEST(JoinedParts, ASurfaceSplitAnywhereKeepsItsVolume) {
  const double whole = volumeOf(ball());
  EXPECT_NEAR(whole, signedVolume(ball()), 1e-3 * whole);
  for (const float z : {0.045f, 0.03f, 0.0f, -0.04f}) {
    SCOPED_TRACE(z);
    const TriangleMesh two = split(ball(), [&](const Vector3f& p) { return p.z() > z; });
    EXPECT_NEAR(volumeOf(two), whole, kJoinRounding * whole);
    EXPECT_EQ(voxelise(two, kCellOfBall).filledCells(), voxelise(ball(), kCellOfBall).filledCells());
    TriangleMesh turned = two;  // one of the parts is inside out
    for (size_t t = 0; t < turned.triangles.size(); ++t)
      if (turned.parts[t] == 1) std::swap(turned.triangles[t][1], turned.triangles[t][2]);
    EXPECT_NEAR(volumeOf(turned), whole, kJoinRounding * whole);
  }
  const TriangleMesh stripe =
      split(ball(), [](const Vector3f& p) { return std::abs(std::atan2(p.y(), p.x())) < 0.1f * kPi; });
  VoxelReport report;
  EXPECT_NEAR(voxeliseByMoments(stripe, kCellOfBall, {}, &report).volumeM3(), whole, kJoinRounding * whole);
  EXPECT_EQ(report.holes_closed, 0);
  EXPECT_EQ(report.parts_dropped, 0) << report.text();
}

TEST(JoinedParts, EachPartHasTheTissueNearestToIt) {
  const Solid solid = voxeliseByMoments(split(ball(), [](const Vector3f& p) { return p.z() > 0.01f; }), kCellOfBall);
  EXPECT_EQ(labelAt(solid, {0, 0, 0.045}), 2);
  EXPECT_EQ(labelAt(solid, {0, 0, 0.03}), 2);
  EXPECT_EQ(labelAt(solid, {0, 0, -0.03}), 1);
  EXPECT_EQ(labelAt(solid, {0.045, 0, -0.005}), 1);
}

TEST(JoinedParts, ThePartsOfATubeAreItsWall) {
  // Outer and inner half of a hollow ball that is open at its top: two parts that meet only at the rim.
  TriangleMesh outer = sphereMesh(Vector3f::Zero(), 0.05f, kBallRings, 8);
  TriangleMesh inner = turnedInsideOut(sphereMesh(Vector3f::Zero(), 0.04f, kBallRings, 8));
  TriangleMesh rim;
  const TriangleMesh both = joined(outer, inner, false);
  const auto inner_first = static_cast<uint32_t>(outer.positions_m.size());
  rim.positions_m = both.positions_m;
  const auto ring = [&](uint32_t sector) { return 2 + 7u * 2 * kBallRings + sector % (2 * kBallRings); };
  for (uint32_t s = 0; s < 2 * kBallRings; ++s) {
    rim.triangles.push_back({ring(s), ring(s + 1), inner_first + ring(s)});
    rim.triangles.push_back({ring(s + 1), inner_first + ring(s + 1), inner_first + ring(s)});
  }
  rim.parts.assign(rim.triangles.size(), 0);
  rim.part_names = {"rim"};
  const TriangleMesh wall = joined(both, rim, false);
  const double exact = std::abs(signedVolume(facingOutward(wall)));
  EXPECT_LT(exact, 0.6 * signedVolume(ball()));
  EXPECT_NEAR(volumeOf(wall, 0.003), exact, 1e-3 * exact);
}

TEST(JoinedParts, AFlangeLeavesWhatItIsFastenedToAsItWas) {
  const TriangleMesh bowl = sphereMesh(Vector3f::Zero(), kBallRadius, kBallRings, kBallRings / 2);
  TriangleMesh flange;
  constexpr int kSectors = 2 * kBallRings;
  for (const float scale : {1.0f, 3.0f})
    for (int s = 0; s < kSectors; ++s) {
      Vector3f p = bowl.positions_m[2 + (kBallRings / 2 - 1) * kSectors + s];
      p.head<2>() *= scale;
      flange.positions_m.push_back(p);
    }
  for (uint32_t s = 0; s < kSectors; ++s) {
    const uint32_t next = (s + 1) % kSectors;
    flange.triangles.push_back({s, next, s + kSectors});
    flange.triangles.push_back({next, next + kSectors, s + kSectors});
  }
  flange.parts.assign(flange.triangles.size(), 0);
  flange.part_names = {"flange"};
  EXPECT_NEAR(volumeOf(joined(bowl, flange, false)), volumeOf(bowl), kJoinRounding * volumeOf(bowl));
}

TEST(JoinedParts, ClosedPartsThatTouchStayApart) {
  const TriangleMesh two =
      joined(boxMesh({0, 0, 0}, {0.1f, 0.1f, 0.1f}), boxMesh({0.1f, 0, 0}, {0.2f, 0.1f, 0.1f}), false);
  const std::vector<ClosedSurface> surfaces = closeSurfaces(two);
  ASSERT_EQ(surfaces.size(), 2u);
  EXPECT_FALSE(surfaces[0].is_joined || surfaces[1].is_joined);
  EXPECT_EQ(facingOutward(two).positions_m.size(), two.positions_m.size());
}

TEST(JoinedParts, FilesThatSplitByMaterialOrGroupBecomeTheSameBody) {
  const TriangleMesh two = split(ball(), [](const Vector3f& p) { return p.z() > 0.03f; });
  BodyConfig config = meshConfig(two, 0.005);
  const double whole = volumeOf(meshConfig(ball(), 0.005));
  std::string text = objText(two);
  for (const std::string key : {"o", "g", "usemtl"}) {
    SCOPED_TRACE(key);
    std::string split_text = text;
    for (const std::string name : {"first", "second"}) split_text.replace(split_text.find("o " + name), 1, key);
    writeFile(config.mesh_file, split_text);
    EXPECT_NEAR(volumeOf(config), whole, kJoinRounding * whole);
    EXPECT_EQ(openEdges(build(config).skin.mesh), 0u) << "the skin is one surface";
  }
  config.mesh_file = temporaryPath("two.stl");
  TriangleMesh first = two, second = two;
  for (TriangleMesh* part : {&first, &second}) {
    part->triangles.clear();
    for (size_t t = 0; t < two.triangles.size(); ++t)
      if (two.parts[t] == (part == &first ? 0 : 1)) part->triangles.push_back(two.triangles[t]);
  }
  writeFile(config.mesh_file, asciiStl(first) + asciiStl(second));
  EXPECT_NEAR(volumeOf(config), whole, kJoinRounding * whole);
}

TEST(DroppedParts, FillEnclosedIsNamedWhereTheyAreMostOfTheSurface) {
  const TriangleMesh core = sphereMesh(Vector3f::Zero(), 0.01f, 16);
  TriangleMesh patches;
  for (int p = 0; p < 4; ++p) {
    TriangleMesh patch = sphereMesh(Vector3f::Zero(), 0.05f, 32, 26);  // a cap: an open sheet
    for (Vector3f& v : patch.positions_m) v = p % 2 ? Vector3f(v.z(), v.x(), v.y()) : Vector3f(-v.x(), v.y(), -v.z());
    patches = p == 0 ? patch : joined(patches, patch, false);
  }
  VoxelReport report;
  voxeliseByMoments(joined(core, patches, false), 0.003, {}, &report);
  EXPECT_GT(report.dropped_surface, 0.5);
  EXPECT_TRUE(contains(report.text(), "fill: enclosed")) << report.text();
  report = {};
  voxeliseByMoments(core, 0.003, {}, &report);
  EXPECT_FALSE(contains(report.text(), "enclosed")) << report.text();
  const std::string message = errorOf<MeshError>(meshConfig(patches, 0.003));
  EXPECT_TRUE(contains(message, "open sheet") && contains(message, "fill: enclosed")) << message;
}

}  // namespace
}  // namespace viscera::test
