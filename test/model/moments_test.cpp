// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include <Eigen/Eigenvalues>
#include <chrono>
#include <random>

#include "body_samples.h"
#include "math/decompositions.h"
#include "model/shape/organ/tissue.h"
#include "solid_probe.h"
#include "viscera/model/shape/mesh_import.h"
#include "viscera/model/shape/solid.h"

namespace viscera::test {
namespace {

const Vector3d kSomewhere(0.0123, -0.0307, 0.0211);  // m, no multiple of any spacing used here
/// For integrals that are exact except for the rounding of single-precision meshes, and for cells below the least share
/// and within a thousandth of full.
constexpr double kExact = 1e-4;

/// Volume, centre of mass and second moments about it.
struct Inertia {
  double volume_m3 = 0;
  Vector3d middle_m = Vector3d::Zero();
  Eigen::Matrix3d second_m5 = Eigen::Matrix3d::Zero();
};

Inertia inertiaOf(const Solid& solid) {
  const double h = solid.spacing_m, cell_m3 = h * h * h;
  Inertia sum;
  size_t next = 0;
  for (size_t i = 0; i < solid.labels.size(); ++i) {
    if (solid.labels[i] == 0) continue;
    const bool partial = next < solid.partial.size() && solid.partial[next].cell == i;
    const CellFill f = partial ? solid.partial[next++].fill : CellFill{};
    const size_t nx = static_cast<size_t>(solid.cells.x()), ny = static_cast<size_t>(solid.cells.y());
    const Vector3d m = solid.origin_m + h * (Vector3d(i % nx, i / nx % ny, i / nx / ny) + Vector3d::Constant(0.5));
    sum.volume_m3 += f.share * cell_m3;
    sum.middle_m += cell_m3 * (f.share * m + h * f.first);
    sum.second_m5 += cell_m3 * (f.share * m * m.transpose() + h * (f.first * m.transpose() + m * f.first.transpose()) +
                                h * h * f.second);
  }
  EXPECT_EQ(next, solid.partial.size()) << "partial cells are labelled and in order";
  sum.middle_m /= sum.volume_m3;
  sum.second_m5 -= sum.volume_m3 * sum.middle_m * sum.middle_m.transpose();
  return sum;
}

void expectPossible(const Solid& solid) {
  for (const PartialCell& p : solid.partial) {
    Eigen::Matrix4d all;  // of (1, p): an energy that is quadratic in both is built from it
    all << p.fill.share, p.fill.first.transpose(), p.fill.first, p.fill.second;
    EXPECT_GT(Eigen::SelfAdjointEigenSolver<Eigen::Matrix4d>(all).eigenvalues().minCoeff(), -1e-9);
    EXPECT_GE(p.fill.share, 1e-2);
    EXPECT_LT(p.fill.share, 1.06) << "six slivers of a hundredth at most";
    EXPECT_TRUE(p.fill.second.isApprox(p.fill.second.transpose()));
  }
}

TriangleMesh placed(TriangleMesh mesh, const Pose& pose) {
  for (Vector3f& p : mesh.positions_m) p = (pose * p.cast<double>()).cast<float>();
  return mesh;
}

Pose turned() {
  return {kSomewhere, Quaterniond(Eigen::AngleAxisd(0.5, Vector3d(0.3, -0.5, 0.8).normalized()))};
}

TEST(Moments, ABoxOfWholeCellsHasFullCellsOnly) {
  const TriangleMesh box = boxMesh({0.1f, 0.2f, 0.3f}, {0.14f, 0.25f, 0.36f});
  const Solid solid = voxeliseByMoments(box, 0.01);
  EXPECT_EQ(solid.cells, Vector3i(4, 5, 6));
  EXPECT_EQ(solid.filledCells(), 4u * 5u * 6u);
  EXPECT_TRUE(solid.partial.empty());
  EXPECT_EQ(solid.labels, voxelise(box, 0.01).labels);
}

TEST(Moments, ATurnedBoxIsExact) {
  const Vector3f half(0.02f, 0.013f, 0.008f);
  const Pose pose = turned();
  const TriangleMesh box = placed(boxMesh(-half, half), pose);
  const Vector3d size = 2 * half.cast<double>();
  const Eigen::Matrix3d r = pose.orientation.toRotationMatrix();
  const Eigen::Matrix3d exact = size.prod() / 12 * r * size.cwiseProduct(size).asDiagonal() * r.transpose();
  for (const double h : {0.03, 0.008, 0.004, 0.002}) {
    const Solid solid = voxeliseByMoments(box, h);
    const Inertia sum = inertiaOf(solid);
    expectPossible(solid);
    EXPECT_NEAR(sum.volume_m3, size.prod(), 1e-3 * size.prod()) << h;
    EXPECT_LT((sum.middle_m - pose.position_m).norm(), 1e-3 * h) << h;
    EXPECT_LT((sum.second_m5 - exact).norm(), 2e-3 * exact.norm()) << h;
  }
}

TEST(Moments, AWallThinnerThanACellIsWhatItIs) {
  // 0.3 cells thick, 10 x 10 cells, inside a layer of cells: no lines along the wall would find it.
  const double h = 0.01;
  NodePlanes planes = {0.0, 0.0, 0.0};
  for (int axis = 0; axis < 3; ++axis) {
    Vector3f low = Vector3f::Zero(), high = Vector3f::Constant(0.1f);
    low[axis] = 0.0015f;
    high[axis] = 0.0045f;
    VoxelReport report;
    const Solid solid = voxeliseByMoments(boxMesh(low, high), h, planes, &report);
    EXPECT_EQ(solid.cells[axis], 1);
    ASSERT_EQ(solid.partial.size(), 100u);
    EXPECT_EQ(report.thin_cells, 0);
    for (const PartialCell& p : solid.partial) {
      EXPECT_NEAR(p.fill.share, 0.3, kExact);
      EXPECT_NEAR(p.fill.first[axis], 0.3 * (0.3 - 0.5), kExact);
      EXPECT_NEAR(p.fill.second(axis, axis), 0.3 * (0.2 * 0.2 + 0.3 * 0.3 / 12), kExact);
      EXPECT_NEAR(p.fill.second((axis + 1) % 3, (axis + 1) % 3), 0.3 / 12, kExact);
    }
  }
}

TEST(Moments, AShiftByAFractionOfACellChangesNothing) {
  const double h = 0.009;
  const TriangleMesh balloon =
      joined(sphereMesh(Vector3f::Zero(), 0.04f, 48), turnedInsideOut(sphereMesh(Vector3f::Zero(), 0.034f, 48)), true);
  const NodePlanes planes = {0.0, 0.0, 0.0};
  const Inertia first = inertiaOf(voxeliseByMoments(balloon, h, planes));
  EXPECT_NEAR(first.volume_m3, signedVolume(balloon), 1e-3 * first.volume_m3);
  std::mt19937 random(1);
  std::uniform_real_distribution<double> within(0, h);
  for (int i = 0; i < 5; ++i) {
    const Vector3d shift(within(random), within(random), within(random));
    const Solid solid = voxeliseByMoments(placed(balloon, {shift, Quaterniond::Identity()}), h, planes);
    const Inertia moved = inertiaOf(solid);
    expectPossible(solid);
    EXPECT_NEAR(moved.volume_m3, first.volume_m3, 1e-3 * first.volume_m3);
    EXPECT_LT((moved.middle_m - shift - first.middle_m).norm(), 1e-3 * h);
    EXPECT_LT((moved.second_m5 - first.second_m5).norm(), 1e-3 * first.second_m5.norm());
    EXPECT_FALSE(outsideReaches(solid, shift)) << "a wall of two thirds of a cell holds tight";
  }
}

TEST(Moments, PartsThatTouchAddUpAndPartsThatOverlapAreTheirUnion) {
  const double h = 0.01;
  const NodePlanes planes = {0.0013, 0.0027, 0.0041};
  const TriangleMesh left = boxMesh({0, 0, 0}, {0.0637f, 0.04f, 0.04f});
  TriangleMesh touching = joined(left, boxMesh({0.0637f, 0, 0}, {0.1f, 0.04f, 0.04f}), false);
  const double volume = 0.1 * 0.04 * 0.04;
  Solid solid = voxeliseByMoments(touching, h, planes);
  EXPECT_NEAR(solid.volumeM3(), volume, kExact * volume);
  TriangleMesh overlapping = joined(left, boxMesh({0.0418f, 0, 0}, {0.1f, 0.04f, 0.04f}), false);
  solid = voxeliseByMoments(overlapping, h, planes);
  EXPECT_NEAR(solid.volumeM3(), volume, 5e-3 * volume) << "sampled where both parts end within a cell";
  expectPossible(solid);
  overlapping = joined(left, boxMesh({0.0418f, 0, 0}, {0.1f, 0.04f, 0.04f}), true);
  EXPECT_NEAR(voxeliseByMoments(overlapping, h, planes).volumeM3(), volume, 2e-2 * volume) << "one part, sampled";
}

TEST(Moments, LabelsAreThoseOfCentresAndElseOfTheLargestShare) {
  const double h = 0.01;
  TriangleMesh mesh = joined(sphereMesh(Vector3f::Zero(), 0.05f, 48), sphereMesh(Vector3f::Zero(), 0.0121f, 48), false);
  mesh.part_names = {"wall", "papillary"};
  const Solid binary = voxelise(mesh, h), solid = voxeliseByMoments(mesh, h);
  ASSERT_EQ(solid.cells, binary.cells);
  for (size_t i = 0; i < solid.labels.size(); ++i) {
    if (binary.labels[i] == 0) continue;
    EXPECT_EQ(solid.labels[i], binary.labels[i]);
  }
  TriangleMesh walls =
      joined(boxMesh({0, 0, 0}, {0.1f, 0.1f, 0.001f}), boxMesh({0, 0, 0.001f}, {0.1f, 0.1f, 0.004f}), false);
  walls.part_names = {"thin", "thick"};
  const Solid layer = voxeliseByMoments(walls, h, {0.0, 0.0, 0.0});
  EXPECT_EQ(layer.filledCells(), 100u);
  for (const uint16_t label : layer.labels) EXPECT_EQ(label, 2);
}

TEST(Moments, PartsInsideOutAndCavitiesAreAsWithoutMoments) {
  const TriangleMesh outer = sphereMesh(kSomewhere.cast<float>(), 0.05f, 32),
                     inner = sphereMesh(kSomewhere.cast<float>(), 0.03f, 32);
  const double h = 0.007, shell = signedVolume(outer) - signedVolume(inner);
  EXPECT_NEAR(voxeliseByMoments(turnedInsideOut(outer), h).volumeM3(), signedVolume(outer), 1e-3 * shell);
  EXPECT_NEAR(voxeliseByMoments(joined(outer, turnedInsideOut(inner), true), h).volumeM3(), shell, 1e-3 * shell);
  EXPECT_NEAR(voxeliseByMoments(joined(outer, inner, true), h).volumeM3(), signedVolume(outer), 1e-3 * shell);
  EXPECT_NEAR(voxeliseByMoments(joined(outer, inner, false), h).volumeM3(), signedVolume(outer), 1e-3 * shell);
}

TEST(Moments, CrumbsAreJudgedByTheirVolume) {
  // Eight cells touched, but half a cell in total.
  TriangleMesh mesh = joined(boxMesh({0, 0, 0}, {0.08f, 0.08f, 0.08f}),
                             boxMesh({0.136f, 0.036f, 0.036f}, {0.144f, 0.044f, 0.044f}), true);
  VoxelReport report;
  const NodePlanes planes = {0.0, 0.0, 0.0};
  voxeliseByMoments(mesh, 0.01, planes, &report);
  EXPECT_EQ(report.crumbs_removed, 1) << "0.512 of 512 cells, though in eight cells";
  mesh = joined(boxMesh({0, 0, 0}, {0.08f, 0.08f, 0.08f}), boxMesh({0.135f, 0.035f, 0.035f}, {0.145f, 0.045f, 0.045f}),
                true);
  const Solid solid = voxeliseByMoments(mesh, 0.01, planes, &report);
  EXPECT_EQ(report.crumbs_removed, 0);
  EXPECT_EQ(countPieces(solid), 2u);
  EXPECT_EQ(solid.partial.size(), 8u) << "full cells are not stored";
}

double ballDistance(const Vector3d& p, double radius_m) {
  return (p - kSomewhere).norm() - radius_m;
}

TEST(Moments, ABallOfEightCellsIsRightToAThousandth) {
  const double radius = 0.02, h = 2 * radius / 8;
  const DistanceField ball = [&](const Vector3d& p) { return LabelledDistance{ballDistance(p, radius), 0}; };
  const Vector3d reach = Vector3d::Constant(radius);
  const double volume = sphereVolume(radius), second = volume * radius * radius / 5;
  for (const Vector3d& shift : {Vector3d(0, 0, 0), Vector3d(0.3, 0.1, 0.7), Vector3d(0.9, 0.45, 0.2)}) {
    const NodePlanes planes = {shift.x() * h, shift.y() * h, shift.z() * h};
    const Solid solid = voxeliseByMoments(ball, {"ball"}, kSomewhere - reach, kSomewhere + reach, h, planes);
    const Inertia sum = inertiaOf(solid);
    expectPossible(solid);
    EXPECT_NEAR(sum.volume_m3, volume, 1e-3 * volume);
    EXPECT_LT((sum.middle_m - kSomewhere).norm(), 1e-3 * h);
    EXPECT_LT((sum.second_m5 - second * Eigen::Matrix3d::Identity()).norm(), 2e-3 * second);
  }
}

TEST(Moments, AFlatFaceOfAFieldIsExact) {
  const Vector3d normal = Vector3d(0.3, -0.5, 0.8).normalized();
  const double h = 0.01;
  const DistanceField half_space = [&](const Vector3d& p) {
    return LabelledDistance{normal.dot(p - Vector3d::Constant(0.041)), 0};
  };
  const Solid solid = voxeliseByMoments(half_space, {"half"}, Vector3d::Zero(), Vector3d::Constant(0.08), h);
  // The same with a mesh: the box below the plane, which is a face of a larger, rotated box.
  const Quaterniond turn = rotationBetween(Vector3d::UnitZ(), normal);
  TriangleMesh below = boxMesh({-0.2f, -0.2f, -0.2f}, {0.2f, 0.2f, 0});
  below = placed(below, {Vector3d::Constant(0.041), turn});
  const Solid exact = voxeliseByMoments(below, h, {0.0, 0.0, 0.0});
  for (const PartialCell& p : solid.partial) {
    const size_t nx = static_cast<size_t>(solid.cells.x()), ny = static_cast<size_t>(solid.cells.y());
    const Vector3d m = h * (Vector3d(p.cell % nx, p.cell / nx % ny, p.cell / nx / ny) + Vector3d::Constant(0.5));
    if ((m.array() < h).any() || (m.array() > 0.07).any()) continue;  // next to what the field's grid leaves out
    const Vector3i there = cellAt(exact, m);
    const size_t index = exact.index(there.x(), there.y(), there.z());
    const auto found =
        std::find_if(exact.partial.begin(), exact.partial.end(), [&](const PartialCell& e) { return e.cell == index; });
    ASSERT_NE(found, exact.partial.end());
    EXPECT_NEAR(p.fill.share, found->fill.share, kExact);
    EXPECT_LT((p.fill.first - found->fill.first).norm(), kExact);
    EXPECT_LT((p.fill.second - found->fill.second).norm(), kExact);
  }
}

Solid filled(const BodyConfig& config) {
  return makeTissue(config, "")->fill(config.spacing_m, {}).solid;
}

TEST(Moments, ABoxAsABodyKeepsItsSize) {
  BodyConfig config = boxConfig({0.05, 0.03, 0.02}, 0.01);
  config.position_m = {0.0123, -0.02, 0.4};
  config.material.law = Law::kSprings;
  const Solid springs = filled(config);
  config.material.law = Law::kNeoHookean;
  Solid solid = filled(config);
  EXPECT_EQ(solid.labels, springs.labels);
  EXPECT_EQ(solid.origin_m, springs.origin_m);
  EXPECT_TRUE(solid.partial.empty());
  config.box_size_m = {0.053, 0.03, 0.003};
  solid = filled(config);
  EXPECT_EQ(solid.cells, Vector3i(6, 3, 1));
  EXPECT_NEAR(solid.volumeM3(), config.box_size_m.prod(), kExact * config.box_size_m.prod());
  EXPECT_LT((solid.origin_m - (config.position_m - 0.5 * config.box_size_m)).norm(), 1e-9);
  config.rotation_deg = {30, 24, 17};
  config.position_m = {1000, -1000, 500};  // double precision throughout
  solid = filled(config);
  EXPECT_NEAR(solid.volumeM3(), config.box_size_m.prod(), 1e-3 * config.box_size_m.prod());
  EXPECT_LT((inertiaOf(solid).middle_m - config.position_m).norm(), 1e-3 * config.spacing_m);
}

TEST(Moments, EverySourceHasItsVolumeAtAnySpacingAndPosition) {
  BodyConfig config = phantomConfig(0.002);
  const double heart_m3 = filled(config).volumeM3();
  for (const double h : {0.006, 0.004, 0.003}) {
    config.spacing_m = h;
    config.position_m += Vector3d(0.0017, 0.0009, 0.0023);
    config.rotation_deg += Vector3d(20, 10, 30);
    const auto start = std::chrono::steady_clock::now();
    EXPECT_NEAR(filled(config).volumeM3(), heart_m3, 5e-3 * heart_m3) << h << ": walls of 4 mm with creases";
    const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
    std::cout << "phantom at " << h << " m in " << took.count() << " s\n";
  }
  config.source = TissueSource::kBall;
  for (const double h : {0.01, 0.006, 0.004}) {
    config.spacing_m = h;
    EXPECT_NEAR(filled(config).volumeM3(), sphereVolume(0.02), 5e-3 * sphereVolume(0.02)) << h;
  }
}

TEST(Moments, NodesKnowHowDeepBelowTheSurfaceTheyLie) {
  BodyConfig ball = boxConfig({0, 0, 0}, 0.005);
  ball.source = TissueSource::kBall;
  BodyConfig mesh = meshConfig(sphereMesh(Vector3f::Zero(), 0.02f, 64), 0.005);
  BodyConfig box = boxConfig({0.043, 0.031, 0.022}, 0.005);
  box.rotation_deg = {10, 20, 30};
  for (BodyConfig config : {ball, mesh, box}) {
    config.position_m = kSomewhere;
    const Lattice lattice = build(config).lattice;
    ASSERT_EQ(lattice.depth_m.size(), lattice.nodes.size());
    const Quaterniond back = Quaterniond(bodyPose(config).orientation).conjugate();
    int outside = 0;
    for (const uint32_t slot : lattice.active_slots) {
      const Vector3d p = back * (lattice.restPosition(slot) - kSomewhere);
      const Vector3d beyond = p.cwiseAbs() - 0.5 * config.box_size_m;
      const double box_depth = -beyond.cwiseMax(0).norm() - std::min(beyond.maxCoeff(), 0.0);
      const double depth = config.source == TissueSource::kBox ? box_depth : 0.02 - p.norm();
      constexpr double kFacets = 3e-5;  // depth of the mesh's facets below the sphere [m]
      EXPECT_NEAR(lattice.depth_m[slot], std::min(depth, 0.005), kFacets);
      outside += depth < 0 ? 1 : 0;
    }
    EXPECT_GT(outside, 100);
  }
}

TEST(Moments, NodesAreCountedOfTheCellsThatWillBe) {
  BodyConfig config = phantomConfig(0);
  config.target_nodes = 3000;
  const Body body = build(config);
  EXPECT_NEAR(body.lattice.active_slots.size(), 3000, 60);
  EXPECT_FALSE(body.lattice.fills.empty());
}

TEST(Moments, TheRealHeartHasTheVolumeOfItsMeshAtAnySpacing) {
  const std::string path = realData("VH_M_Heart.glb");
  if (path.empty()) GTEST_SKIP() << "VH_M_Heart.glb not found; set VISCERA_TEST_DATA";
  const TriangleMesh heart = importMesh(path, 1);
  constexpr double kVolume = 266.5e-6;  // m3, volume of the union of its parts: the limit of fine grids
  for (const double h : {0.006, 0.004, 0.002}) {
    VoxelReport report;
    const auto start = std::chrono::steady_clock::now();
    const Solid solid = voxeliseByMoments(heart, h, {}, &report);
    const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
    std::cout << "heart at " << h << " m in " << took.count() << " s: " << report.text() << ", " << solid.partial.size()
              << " of " << solid.filledCells() << " cells in part\n";
    expectPossible(solid);
    EXPECT_NEAR(solid.volumeM3(), kVolume, 0.01 * kVolume);
    EXPECT_EQ(report.thin_cells, 0);
  }
}

TEST(Moments, ProgressEndsAtOne) {
  double last = 0;
  const Progress progress = [&](const std::string&, double fraction) {
    EXPECT_GE(fraction, last);
    last = fraction;
  };
  voxeliseByMoments(sphereMesh(Vector3f::Zero(), 0.05f, 8), 0.01, {}, nullptr, progress);
  EXPECT_DOUBLE_EQ(last, 1);
  last = 0;
  const DistanceField ball = [&](const Vector3d& p) { return LabelledDistance{ballDistance(p, 0.02), 0}; };
  voxeliseByMoments(ball, {"ball"}, kSomewhere - Vector3d::Constant(0.02), kSomewhere + Vector3d::Constant(0.02), 0.004,
                    {}, progress);
  EXPECT_DOUBLE_EQ(last, 1);
}

}  // namespace
}  // namespace viscera::test
