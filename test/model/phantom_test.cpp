// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "model/shape/organ/phantom.h"

#include <limits>
#include <set>

#include "math/union_find.h"
#include "mesh_samples.h"
#include "model/body/spacing_search.h"
#include "solid_probe.h"
#include "viscera/math/error.h"

namespace viscera::test {
namespace {

constexpr double kLength = 0.1;            // m
constexpr double kLoose = 0.15 * kLength;  // m, margin of the box: it is computed before corners are rounded
constexpr double kSpacings[] = {0.002, 0.003, 0.004, 0.042 * kLength};  // up to the thinnest wall
enum Chamber { kLeftVentricle, kRightVentricle, kLeftAtrium, kRightAtrium };

Solid solidOf(const Phantom& phantom, double spacing_m) {
  return voxelise(phantom.field, phantom.part_names, phantom.min_m, phantom.max_m, spacing_m);
}

/// Returns the number of the empty region around a chamber's centre; 1 is outside.
int regionOf(const Phantom& phantom, const Solid& solid, const Pieces& regions, Chamber chamber) {
  return regions.at(cellAt(solid, phantom.chamber_centers_m.at(chamber)));
}

/// Fills the septal defect with tissue.
void closeDefect(const Phantom& phantom, Solid& solid) {
  const Vector3d axis = (phantom.defect_to_m - phantom.defect_from_m).normalized();
  const double length = (phantom.defect_to_m - phantom.defect_from_m).norm();
  const double radius = phantom.defect_radius_m + solid.spacing_m;
  for (size_t i = 0; i < solid.labels.size(); ++i) {
    const int at = static_cast<int>(i);
    const Vector3i cell(at % solid.cells.x(), at / solid.cells.x() % solid.cells.y(),
                        at / solid.cells.x() / solid.cells.y());
    const Vector3d p = solid.origin_m + solid.spacing_m * (cell.cast<double>() + Vector3d::Constant(0.5));
    const double along = (p - phantom.defect_from_m).dot(axis);
    const double aside = (p - phantom.defect_from_m - along * axis).norm();
    if (along > 0 && along < length && aside < radius) solid.labels[i] = 5;
  }
}

/// Returns the length of tissue outward from a chamber [m].
double wallThickness(const Phantom& phantom, Chamber chamber, const Vector3d& direction) {
  constexpr double kStep = 1e-4;
  double tissue = 0;
  for (double distance = 0; distance < kLength; distance += kStep) {
    const Vector3d p = phantom.chamber_centers_m.at(chamber) + distance * direction.normalized();
    if (phantom.field(p).distance_m < 0) tissue += kStep;
  }
  return tissue;
}

TEST(HeartPhantom, ListsItsWallsTheThinnestFirst) {
  const std::vector<Wall> walls = heartPhantom(kLength, 0.5).walls;
  ASSERT_EQ(walls.size(), 7u);  // all parts except the septum
  EXPECT_NEAR(walls.front().thickness_m, 0.5 * 0.042 * kLength, 1e-12);
  EXPECT_EQ(walls.front().part, "aorta");
  EXPECT_EQ(walls.back().part, "left_ventricle");
  const double measured_m = wallThickness(heartPhantom(kLength, 1), kLeftVentricle, {1, 0, 0});
  // The path is oblique, and walls are blended.
  EXPECT_NEAR(measured_m, 2 * walls.back().thickness_m, 0.2 * measured_m);
}

TEST(HeartPhantom, IsOnePiece) {
  const Phantom heart = heartPhantom(kLength, 1);
  for (const double h : kSpacings) EXPECT_EQ(countPieces(solidOf(heart, h)), 1u) << h;
}

TEST(HeartPhantom, EveryChamberIsAClosedCavityAndTheDefectJoinsTheVentricles) {
  const Phantom heart = heartPhantom(kLength, 1);
  for (const double h : kSpacings) {
    Solid solid = solidOf(heart, h);
    const Pieces open = findPieces(solid, false);
    std::set<int> regions;
    for (const Chamber c : {kLeftVentricle, kLeftAtrium, kRightAtrium}) {
      regions.insert(regionOf(heart, solid, open, c));
      EXPECT_GT(regionOf(heart, solid, open, c), 1) << h << ": chamber " << c << " is tissue or open to the outside";
    }
    EXPECT_EQ(regions.size(), 3u) << h;
    EXPECT_EQ(regionOf(heart, solid, open, kRightVentricle), regionOf(heart, solid, open, kLeftVentricle)) << h;
    closeDefect(heart, solid);
    const Pieces closed = findPieces(solid, false);
    EXPECT_NE(regionOf(heart, solid, closed, kRightVentricle), regionOf(heart, solid, closed, kLeftVentricle)) << h;
  }
}

TEST(HeartPhantom, EveryPartHasCells) {
  const Phantom heart = heartPhantom(kLength, 1);
  const Solid solid = solidOf(heart, 0.004);
  const std::set<uint16_t> labels(solid.labels.begin(), solid.labels.end());
  EXPECT_EQ(labels.size(), heart.part_names.size() + 1);
  const std::vector<std::string> names = {"left_ventricle", "right_ventricle", "left_atrium",      "right_atrium",
                                          "septum",         "aorta",           "pulmonary_artery", "vena_cava"};
  EXPECT_EQ(heart.part_names, names);
}

TEST(HeartPhantom, LeftVentricleHasTheThickWall) {
  const Phantom heart = heartPhantom(kLength, 1);
  const double left = wallThickness(heart, kLeftVentricle, {1, 0, 0});
  const double right = wallThickness(heart, kRightVentricle, {-1, -0.5, 0});
  EXPECT_NEAR(left, 0.012, 0.004);
  EXPECT_NEAR(right, 0.005, 0.002);
  EXPECT_NEAR(wallThickness(heartPhantom(kLength, 0.5), kLeftVentricle, {1, 0, 0}), 0.5 * left, 0.0005);
}

TEST(HeartPhantom, ArteriesAreTubesOpenToTheOutside) {
  const Phantom heart = heartPhantom(kLength, 1);
  const Solid solid = solidOf(heart, 0.002);
  const Pieces empty = findPieces(solid, false);
  for (const uint16_t label : {6, 7}) {  // aorta, pulmonary artery
    Vector3d sum = Vector3d::Zero();
    int count = 0;
    for (size_t i = 0; i < solid.labels.size(); ++i) {
      if (solid.labels[i] != label) continue;
      const int at = static_cast<int>(i);
      sum += Vector3d(at % solid.cells.x(), at / solid.cells.x() % solid.cells.y(),
                      at / solid.cells.x() / solid.cells.y());
      ++count;
    }
    const Vector3i middle = (sum / count).array().round().cast<int>();
    EXPECT_EQ(empty.at(middle), 1) << "the middle of a tube is its lumen: label " << label;
  }
}

TEST(HeartPhantom, IsCentredInABoxThatHoldsItTightly) {
  for (const double wall_scale : {0.3, 1.0, 2.0}) {
    const Phantom heart = heartPhantom(kLength, wall_scale);
    EXPECT_LT((heart.min_m + heart.max_m).norm(), 1e-12);
    const double h = 0.002;
    const Solid solid = voxelise(heart.field, heart.part_names, heart.min_m - Vector3d::Constant(0.03),
                                 heart.max_m + Vector3d::Constant(0.03), h);
    Eigen::AlignedBox3d tissue;
    for (int z = 0; z < solid.cells.z(); ++z) {
      for (int y = 0; y < solid.cells.y(); ++y) {
        for (int x = 0; x < solid.cells.x(); ++x) {
          if (solid.label(x, y, z)) tissue.extend(solid.origin_m + h * Vector3d(x + 0.5, y + 0.5, z + 0.5));
        }
      }
    }
    EXPECT_TRUE((tissue.min().array() >= heart.min_m.array()).all()) << wall_scale;
    EXPECT_TRUE((tissue.max().array() <= heart.max_m.array()).all()) << wall_scale;
    EXPECT_LT((heart.max_m - heart.min_m - tissue.sizes()).maxCoeff(), kLoose + h) << wall_scale;
  }
}

TEST(HeartPhantom, HasThousandsOfNodesAtFourMillimetres) {
  const size_t nodes = countNodes(solidOf(heartPhantom(kLength, 1), 0.004));
  EXPECT_GT(nodes, 5000u);
  EXPECT_LT(nodes, 11000u);
}

TEST(HeartPhantom, ScalesWithItsLength) {
  const Phantom small = heartPhantom(kLength, 1), large = heartPhantom(2 * kLength, 1);
  EXPECT_EQ(solidOf(small, 0.004).labels, solidOf(large, 0.008).labels);
  EXPECT_NEAR(large.field({0.02, 0.03, 0.04}).distance_m, 2 * small.field({0.01, 0.015, 0.02}).distance_m, 1e-12);
}

TEST(HeartPhantom, ItsSkinIsClosedWithOneSurfaceOutsideAndThreeInside) {
  const Phantom heart = heartPhantom(kLength, 1);
  const TriangleMesh skin = extractSkin(heart.field, heart.part_names, heart.min_m, heart.max_m, 0.003);
  EXPECT_EQ(openEdges(skin), 0u);
  EXPECT_NEAR(signedVolume(skin), solidOf(heart, 0.002).volumeM3(), 0.03 * signedVolume(skin));
  UnionFind joined(skin.positions_m.size());
  for (const auto& t : skin.triangles) {
    joined.unite(t[0], t[1]);
    joined.unite(t[1], t[2]);
  }
  const std::vector<uint32_t> surface_of = std::move(joined).all();
  EXPECT_EQ(std::set<uint32_t>(surface_of.begin(), surface_of.end()).size(), 4u);
}

TEST(HeartPhantom, RefusesParametersOutOfRange) {
  for (const double bad : {0.0, 0.009, 1.1, std::numeric_limits<double>::quiet_NaN()}) {
    EXPECT_THROW(heartPhantom(bad, 1), SceneError);
  }
  for (const double bad : {0.0, 0.09, 2.1, std::numeric_limits<double>::quiet_NaN()}) {
    EXPECT_THROW(heartPhantom(kLength, bad), SceneError);
  }
}

}  // namespace
}  // namespace viscera::test
