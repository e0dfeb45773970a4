// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <map>
#include <random>

#include "model/mesh_samples.h"
#include "model/shape/enclosed/enclosed_solid.h"
#include "model/shape/enclosed/enclosed_surface.h"
#include "viscera/math/error.h"

namespace viscera::test {
namespace {

constexpr float kRadius = 0.04f;  ///< [m]
constexpr int kRings = 40;        ///< rings of the spheres: triangles of 3 mm
constexpr int kPatches = 10;
constexpr double kEnclosedExact = 0.005;  ///< relative error of the enclosed volume, on any grid
constexpr float kHalfGap = 0.00025f;      ///< [m]
const Vector3f kMiddle(0.01f, -0.02f, 0.03f);

/// Returns a part of a sphere's triangles, each patch with vertices of its own.
template <class Keeps>
TriangleMesh cutOut(const TriangleMesh& from, const std::string& name, Keeps keeps) {
  TriangleMesh out;
  out.part_names = {name};
  std::map<uint32_t, uint32_t> number;
  for (const auto& t : from.triangles) {
    if (!keeps((from.positions_m[t[0]] + from.positions_m[t[1]] + from.positions_m[t[2]]) / 3 - kMiddle)) continue;
    std::array<uint32_t, 3> own;
    for (int c = 0; c < 3; ++c) {
      const auto [found, is_new] = number.try_emplace(t[c], static_cast<uint32_t>(out.positions_m.size()));
      if (is_new) out.positions_m.push_back(from.positions_m[t[c]]);
      own[c] = found->second;
    }
    out.triangles.push_back(own);
    out.parts.push_back(0);
  }
  return out;
}

/// Returns ten open patches 0.5 mm apart, every other one inside out; inside, a capsule of two sheets with a hole.
TriangleMesh patchedBall() {
  std::mt19937 random(5);
  std::normal_distribution<float> normal;
  std::vector<Vector3f> seeds;
  while (seeds.size() < kPatches) {
    const Vector3f seed = Vector3f(normal(random), normal(random), normal(random)).normalized();
    const auto near = [&](const Vector3f& other) { return seed.dot(other) > std::cos(0.75f); };
    if (std::none_of(seeds.begin(), seeds.end(), near)) seeds.push_back(seed);
  }
  TriangleMesh all;
  const TriangleMesh sphere = sphereMesh(kMiddle, kRadius, kRings);
  for (int p = 0; p < kPatches; ++p) {
    TriangleMesh patch = cutOut(sphere, "patch " + std::to_string(p), [&](const Vector3f& at) {
      return std::all_of(seeds.begin(), seeds.end(), [&](const Vector3f& s) { return s.dot(at) <= seeds[p].dot(at); });
    });
    for (Vector3f& v : patch.positions_m) {  // contracted on the sphere
      const Vector3f n = (v - kMiddle).normalized(), along = seeds[p] - seeds[p].dot(n) * n;
      if (along.norm() > 0.1f) v += kHalfGap * along.normalized();
      v = kMiddle + kRadius * (v - kMiddle).normalized();
    }
    if (p % 2 == 1) patch = turnedInsideOut(patch);
    all = all.triangles.empty() ? patch : joined(all, patch, false);
  }
  for (const float radius : {0.038f, 0.0377f}) {
    const TriangleMesh sheet = cutOut(sphereMesh(kMiddle, radius, kRings), "capsule",
                                      [&](const Vector3f& at) { return at.z() < 0.9f * radius; });
    all = joined(all, radius < 0.038f ? turnedInsideOut(sheet) : sheet, false);
  }
  return all;
}

/// Returns the volume of the sphere with flat triangles.
double drawnVolume() {
  return std::abs(signedVolume(sphereMesh(kMiddle, kRadius, kRings)));
}

TEST(Enclosed, BallOfPatches) {
  const TriangleMesh mesh = patchedBall();
  for (const double step_m : {0.001, 0.002}) {
    const EnclosedSurface found = enclosedSurface(mesh, step_m, 0.004);
    EXPECT_NEAR(found.volume_m3, drawnVolume(), kEnclosedExact * drawnVolume()) << found.text();
    EXPECT_NEAR(signedVolume(found.mesh), drawnVolume(), kEnclosedExact * drawnVolume()) << found.text();
    EXPECT_TRUE(found.settled);
  }
}

TEST(Enclosed, CellsOfBallOfPatches) {
  const TriangleMesh mesh = patchedBall();
  for (const double spacing_m : {0.004, 0.008}) {
    std::string note;
    const Solid solid = voxeliseEnclosed(mesh, spacing_m, 0.004, true, {}, note);
    EXPECT_NEAR(solid.volumeM3(), drawnVolume(), kEnclosedExact * drawnVolume()) << note;
    EXPECT_NE(note.find("encloses"), std::string::npos);
    std::vector<int> cells(solid.part_names.size() + 1, 0);
    for (const uint16_t label : solid.labels) ++cells[label];
    for (int patch = 0; patch < kPatches; ++patch) EXPECT_GT(cells[patch + 1], 0) << "patch " << patch;
    EXPECT_EQ(solid.part_names.back(), "enclosed");
    EXPECT_GT(cells.back(), 0);
  }
}

TEST(Enclosed, HoleIsClosedUpToItsWidthAndReported) {
  // A hole of 3 rings around the pole: 3 * pi / 40 * 40 mm from it, so 18.8 mm wide.
  const TriangleMesh mesh = sphereMesh(kMiddle, kRadius, kRings, 3);
  const EnclosedSurface closed = enclosedSurface(mesh, 0.001, 0.03);
  EXPECT_NEAR(closed.volume_m3, drawnVolume(), 0.02 * drawnVolume());  // the hole is closed flat, not as a dome
  EXPECT_GT(closed.hole_m, 0.018);
  EXPECT_LT(closed.hole_m, 2 * 0.019);  // radii are doubled
  EXPECT_LT(enclosedSurface(mesh, 0.001, 0.006).volume_m3, 0.1 * drawnVolume());
}

TEST(Enclosed, ClosedBoxIsItself) {
  const TriangleMesh box = boxMesh({0, 0, 0}, {0.03f, 0.02f, 0.01f});
  const EnclosedSurface found = enclosedSurface(box, 0.0005, 0.002);
  EXPECT_NEAR(found.volume_m3, 6e-6, kEnclosedExact * 6e-6);
  EXPECT_EQ(found.hole_m, 0);
  std::string note;
  const Solid solid = voxeliseEnclosed(box, 0.002, 0.002, false, {}, note);
  EXPECT_EQ(solid.part_names, (std::vector<std::string>{"box", "enclosed"}));
  size_t of_box = 0;
  for (const uint16_t label : solid.labels) of_box += label == 1;
  EXPECT_EQ(of_box, solid.filledCells());  // a closed part keeps its name throughout
}

TEST(Enclosed, AGridThatIsCoarserThanAskedIsSaid) {
  const TriangleMesh mesh = boxMesh({0, 0, 0}, {0.03f, 0.02f, 0.01f});
  EXPECT_EQ(enclosedSurface(mesh, 0.0005, 0.002).text().find("coarser"), std::string::npos);
  constexpr double kFew = 2e5;  // points
  const EnclosedSurface wide = enclosedSurface(mesh, 0.0005, 0.1, kFew);
  EXPECT_GT(wide.step_m, wide.asked_step_m);
  EXPECT_GT(enclosedSurface(mesh, 0.0005, 1.01 * wide.fine_gap_m / 0.95, kFew).step_m, 0.0005);
  EXPECT_EQ(enclosedSurface(mesh, 0.0005, wide.fine_gap_m, kFew).step_m, 0.0005);
  EXPECT_NE(enclosedSurface(mesh, 0.0001, 0.001, kFew).text().find("times as large"), std::string::npos);
  EXPECT_NE(wide.text().find("coarser than the 0.5 mm"), std::string::npos) << wide.text();
  EXPECT_NE(wide.text().find("gap_m of at most"), std::string::npos) << wide.text();
}

TEST(Enclosed, NothingIsEnclosedByNothing) {
  EXPECT_THROW(enclosedSurface({}, 0.001, 0.004), MeshError);
}

}  // namespace
}  // namespace viscera::test
