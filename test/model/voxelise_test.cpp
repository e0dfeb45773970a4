// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include <random>

#include "mesh_samples.h"
#include "solid_probe.h"
#include "viscera/model/shape/mesh_import.h"
#include "viscera/model/shape/solid.h"

namespace viscera::test {
namespace {

constexpr float kVoxeliseRadius = 0.05f;  // m
constexpr int kVoxeliseRings = 48;
const Vector3f kVoxeliseCenter(0.012f, -0.3f, 0.207f);  // no multiple of any spacing used here

double filled(const TriangleMesh& mesh, double spacing_m) {
  return voxelise(mesh, spacing_m).volumeM3();
}

TEST(Voxelise, ABoxOfWholeCellsIsFilledExactly) {
  const Solid solid = voxelise(boxMesh({0.1f, 0.2f, 0.3f}, {0.14f, 0.25f, 0.36f}), 0.01);
  EXPECT_EQ(solid.cells, Vector3i(4, 5, 6));
  EXPECT_EQ(solid.filledCells(), 4u * 5u * 6u);
  EXPECT_NEAR(solid.origin_m.z(), 0.3, 1e-7);  // m, single precision
}

TEST(Voxelise, VolumeOfASphereConvergesWithTheSpacing) {
  const TriangleMesh sphere = sphereMesh(kVoxeliseCenter, kVoxeliseRadius, kVoxeliseRings);
  const double exact = signedVolume(sphere);
  // The number of lattice points in a ball is off by less than 6 (R/h) points out of 4/3 pi (R/h)^3.
  for (const double cells : {5, 10, 20, 40}) {
    EXPECT_NEAR(filled(sphere, kVoxeliseRadius / cells), exact, 1.5 * std::pow(cells, -2) * exact) << cells;
  }
}

TEST(Voxelise, ExactlyTheCellsWithTheirCentreInsideAreFilled) {
  const double h = 0.0031;
  const double facets =
      kVoxeliseRadius * (1 - std::cos(kPi / (2 * kVoxeliseRings)));  // depth of the facets below the sphere
  const Solid solid = voxelise(sphereMesh(kVoxeliseCenter, kVoxeliseRadius, kVoxeliseRings), h);
  for (int z = 0; z < solid.cells.z(); ++z) {
    for (int y = 0; y < solid.cells.y(); ++y) {
      for (int x = 0; x < solid.cells.x(); ++x) {
        const Vector3d center = solid.origin_m + h * Vector3d(x + 0.5, y + 0.5, z + 0.5);
        const double radius = (center - kVoxeliseCenter.cast<double>()).norm();
        if (radius > kVoxeliseRadius || radius < kVoxeliseRadius - 2 * facets) {
          ASSERT_EQ(solid.label(x, y, z), radius < kVoxeliseRadius ? 1 : 0) << x << ' ' << y << ' ' << z;
        }
      }
    }
  }
}

TEST(Voxelise, AnInnerSurfaceThatFacesInwardBoundsACavity) {
  const TriangleMesh outer = sphereMesh(kVoxeliseCenter, kVoxeliseRadius, kVoxeliseRings),
                     inner = sphereMesh(kVoxeliseCenter, 0.03f, kVoxeliseRings);
  const double h = 0.002;
  const Solid shell = voxelise(joined(outer, turnedInsideOut(inner), true), h);
  EXPECT_EQ(labelAt(shell, kVoxeliseCenter.cast<double>()), 0);
  EXPECT_EQ(shell.filledCells(), voxelise(outer, h).filledCells() - voxelise(inner, h).filledCells());
  EXPECT_FALSE(outsideReaches(shell, kVoxeliseCenter.cast<double>()));
  EXPECT_EQ(voxelise(joined(outer, inner, true), h).filledCells(), voxelise(outer, h).filledCells())
      << "an inner surface that faces outward is tissue within tissue";
}

TEST(Voxelise, OrientationOfThePartDoesNotMatter) {
  TriangleMesh sphere = sphereMesh(kVoxeliseCenter, kVoxeliseRadius, kVoxeliseRings);
  const std::vector<uint16_t> expected = voxelise(sphere, 0.004).labels;
  EXPECT_EQ(voxelise(turnedInsideOut(sphere), 0.004).labels, expected);
  std::mt19937 random(3);
  for (auto& t : sphere.triangles) {
    if (random() % 3 == 0) std::swap(t[1], t[2]);
  }
  EXPECT_EQ(voxelise(sphere, 0.004).labels, expected) << "a third of the triangles is turned";
}

TEST(Voxelise, AHoleIsCappedAndCounted) {
  const double h = 0.002;
  VoxelReport report;
  const TriangleMesh open = sphereMesh(kVoxeliseCenter, kVoxeliseRadius, kVoxeliseRings, kVoxeliseRings / 4);
  const Solid solid = voxelise(open, h, &report);
  EXPECT_EQ(report.holes_closed, 1);
  // The cap is a flat cut at 45 degrees: the sphere without the part above it.
  const double height = kVoxeliseRadius * (1 - std::sqrt(0.5)),
               cut = kPi * height * height * (kVoxeliseRadius - height / 3);
  EXPECT_NEAR(solid.volumeM3(), sphereVolume(kVoxeliseRadius) - cut, 0.01 * sphereVolume(kVoxeliseRadius));
  EXPECT_NEAR(report.mesh_volume_m3, sphereVolume(kVoxeliseRadius) - cut, 0.01 * sphereVolume(kVoxeliseRadius));
}

TEST(Voxelise, OverlappingSpheresAreTheirUnionInOnePartOrTwo) {
  const TriangleMesh a = sphereMesh(kVoxeliseCenter, kVoxeliseRadius, kVoxeliseRings);
  const TriangleMesh b = sphereMesh(kVoxeliseCenter + Vector3f(kVoxeliseRadius, 0, 0), kVoxeliseRadius, kVoxeliseRings);
  // Two unit spheres at distance one share 5 pi / 12.
  const double both = 2 * sphereVolume(kVoxeliseRadius) - 5 * kPi / 12 * std::pow(kVoxeliseRadius, 3);
  for (const bool same_part : {true, false}) {
    EXPECT_NEAR(filled(joined(a, b, same_part), 0.002), both, 0.01 * both) << same_part;
  }
}

TEST(Voxelise, ASmallPartIsNotSwallowedByALargeOneAroundIt) {
  TriangleMesh mesh = joined(sphereMesh(kVoxeliseCenter, kVoxeliseRadius, kVoxeliseRings),
                             sphereMesh(kVoxeliseCenter, 0.01f, kVoxeliseRings), false);
  mesh.part_names = {"wall", "papillary"};
  const Solid solid = voxelise(mesh, 0.002);
  EXPECT_EQ(labelAt(solid, kVoxeliseCenter.cast<double>()), 2);
  EXPECT_EQ(labelAt(solid, kVoxeliseCenter.cast<double>() + Vector3d(0.03, 0, 0)), 1);
}

TEST(Voxelise, AWallThinnerThanACellStaysTight) {
  const double h = 0.004;
  const float thickness = 0.0012f;
  const TriangleMesh balloon =
      joined(sphereMesh(kVoxeliseCenter, kVoxeliseRadius, kVoxeliseRings),
             turnedInsideOut(sphereMesh(kVoxeliseCenter, kVoxeliseRadius - thickness, kVoxeliseRings)), true);
  VoxelReport report;
  const Solid solid = voxelise(balloon, h, &report);
  EXPECT_GT(report.thin_cells, 0);
  EXPECT_FALSE(outsideReaches(solid, kVoxeliseCenter.cast<double>())) << "the wall has become a sieve";
  EXPECT_EQ(labelAt(solid, kVoxeliseCenter.cast<double>()), 0);
  const double one_cell_thick = 4 * kPi * kVoxeliseRadius * kVoxeliseRadius * h;
  EXPECT_LT(solid.volumeM3(), 1.6 * one_cell_thick) << "stairs cost at most as much as the slope of 45 degrees in 3d";
}

TEST(Voxelise, ThinWallRuleLeavesThickBodiesAlone) {
  VoxelReport report;
  const Solid solid = voxelise(sphereMesh(kVoxeliseCenter, kVoxeliseRadius, kVoxeliseRings), 0.005, &report);
  EXPECT_EQ(report.thin_cells, 0);
  EXPECT_GT(solid.filledCells(), 0u);
}

TEST(Voxelise, PartsWithoutCellsAreNamed) {
  TriangleMesh mesh = joined(sphereMesh(kVoxeliseCenter, kVoxeliseRadius, kVoxeliseRings),
                             sphereMesh(kVoxeliseCenter, kVoxeliseRadius, 8, 7), false);
  mesh = joined(mesh, sphereMesh(kVoxeliseCenter + Vector3f(0.0001f, 0, 0), 0.00001f, 8), false);
  mesh.part_names = {"ball", "sheet", "speck"};
  VoxelReport report;
  voxelise(mesh, 0.005, &report);
  EXPECT_EQ(report.parts_dropped, 2);
  EXPECT_EQ(report.dropped_names, (std::vector<std::string>{"sheet", "speck"}));
  EXPECT_NE(report.text().find("2 parts dropped: sheet, speck"), std::string::npos) << report.text();
}

TEST(Voxelise, CrumbsAreRemovedAndLargerPiecesStay) {
  TriangleMesh mesh = joined(sphereMesh(kVoxeliseCenter, kVoxeliseRadius, kVoxeliseRings),
                             sphereMesh(kVoxeliseCenter + Vector3f(0.1f, 0, 0), 0.0021f, 8), true);
  mesh = joined(mesh, sphereMesh(kVoxeliseCenter - Vector3f(0.1f, 0, 0), 0.01f, 8), true);
  VoxelReport report;
  const Solid solid = voxelise(mesh, 0.002, &report);
  EXPECT_EQ(report.crumbs_removed, 1);
  EXPECT_EQ(countPieces(solid), 2u);
}

TEST(Voxelise, ProgressEndsAtOne) {
  double last = 0;
  int calls = 0;
  voxelise(sphereMesh(kVoxeliseCenter, kVoxeliseRadius, 8), 0.01, nullptr,
           [&](const std::string& stage, double fraction) {
             EXPECT_EQ(stage, "voxelise");
             EXPECT_GE(fraction, last);
             last = fraction;
             ++calls;
           });
  EXPECT_GT(calls, 1);
  EXPECT_DOUBLE_EQ(last, 1);
}

TEST(Voxelise, ABoxSolidIsRoundedToWholeCells) {
  EXPECT_EQ(boxSolid(Vector3d::Zero(), {0.101, 0.049, 0.0001}, 0.01).cells, Vector3i(10, 5, 1));
}

TEST(Voxelise, TheRealHeartHasHollowChambersInSolidWalls) {
  const std::string path = realData("VH_M_Heart.glb");
  if (path.empty()) GTEST_SKIP() << "VH_M_Heart.glb not found; set VISCERA_TEST_DATA";
  const TriangleMesh heart = importMesh(path, 1);
  // docs/volumes.md
  constexpr double kFilled = 0.01;
  for (const auto& [h, filled_m3] : {std::pair(0.004, 286e-6), {0.002, 268e-6}}) {
    VoxelReport report;
    const Solid solid = voxelise(heart, h, &report);
    std::cout << "heart at " << h << " m: " << report.text() << '\n';
    // The parts hold 297 cm3 and overlap by about a tenth; atrial walls of 2 mm grow to one cell where cells are
    // larger.
    EXPECT_NEAR(report.mesh_volume_m3, 297e-6, 1e-6);
    EXPECT_NEAR(solid.volumeM3() / filled_m3, 1, kFilled) << h;
    EXPECT_EQ(report.parts_dropped, 0) << report.text();
    EXPECT_EQ(labelAt(solid, {0.030, 0.475, 0.035}), 0) << "left ventricle";
    EXPECT_EQ(labelAt(solid, {0.005, 0.470, 0.062}), 0) << "right ventricle";
    EXPECT_EQ(labelAt(solid, {-0.012, 0.470, 0.030}), 0) << "right atrium";
    EXPECT_EQ(labelAt(solid, {0.004, 0.495, 0.000}), 0) << "left atrium";
  }
}

TEST(Voxelise, TheBunnyIsFilledThoughItHasHoles) {
  const std::string path = realData("bunny.obj");
  if (path.empty()) GTEST_SKIP() << "bunny.obj not found; set VISCERA_TEST_DATA";
  VoxelReport report;
  const Solid solid = voxelise(importMesh(path, 1), 0.003, &report);
  std::cout << "bunny: " << report.text() << '\n';
  EXPECT_EQ(report.holes_closed, 5);
  EXPECT_NEAR(solid.volumeM3(), 755e-6, 8e-6);
  EXPECT_EQ(countPieces(solid), 1u);
}

}  // namespace
}  // namespace viscera::test
