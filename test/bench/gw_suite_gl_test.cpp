// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <set>

#include "bench/gw/gw_kernels.h"
#include "bench/gw/gw_network.h"
#include "bench/gw/gw_triangulation.h"
#include "bench/harness/experiment.h"
#include "solver/reference/reference_solver.h"
#include "support/process.h"
#include "support/source_folder.h"
#include "support/text.h"
#include "viscera/gpu/context.h"

namespace viscera::bench {
namespace {

constexpr double kFloat = 2e-6;   ///< share of the largest force: error of float32 sums
constexpr double kMotion = 1e-5;  ///< share of the largest u, after kSubsteps
constexpr int kSubsteps = 50;

Misfit errorOf(const GwNetwork& network, const Field& measured, const Field& truth) {
  return misfit(network.model, {{measured}, 0}, {{truth}, 0});
}

// A square of two triangles, corners 0 1 2 3 counter-clockwise, with its diagonal from 0 to 2.
class Square : public ::testing::Test {
 protected:
  Square() : triangulation(at_m, {{0, 1, 2}, {0, 2, 3}}) {}
  bool hasEdge(uint32_t a, uint32_t b) const {
    const auto triangles = triangulation.triangles();
    return std::all_of(triangles.begin(), triangles.end(), [&](const auto& t) {
      return std::count(t.begin(), t.end(), a) == 1 && std::count(t.begin(), t.end(), b) == 1;
    });
  }
  std::vector<Vector3d> at_m{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  Triangulation triangulation;
  std::mt19937 random{1};
};

TEST_F(Square, FlipsItsDiagonal) {
  ASSERT_TRUE(hasEdge(0, 2));
  std::set<bool> seen;  // the number of attempts does not determine the last diagonal
  for (int i = 0; i < 20; ++i) {
    triangulation.flipAtRandom({2, 3, 2}, random);
    EXPECT_NE(hasEdge(0, 2), hasEdge(1, 3));
    seen.insert(hasEdge(0, 2));
  }
  EXPECT_EQ(seen.size(), 2u);
}

TEST_F(Square, FlipsNothingThatWouldBreakABound) {
  triangulation.flipAtRandom({3, 12, 2}, random);  // its ends have three edges
  EXPECT_TRUE(hasEdge(0, 2));
  triangulation.flipAtRandom({2, 12, 1.2}, random);  // shorter than a diagonal
  EXPECT_TRUE(hasEdge(0, 2));
}

TEST_F(Square, FlipsNothingThatIsNotConvex) {
  at_m[2] = {0.3, 0.3, 0};
  triangulation.flipAtRandom({2, 12, 2}, random);
  EXPECT_TRUE(hasEdge(0, 2));
}

double areaOf(const SpringNetwork& network) {
  double area_m2 = 0;
  for (const auto& t : network.triangles) {
    const Vector3d &a = network.positions_m[t[0]], &b = network.positions_m[t[1]], &c = network.positions_m[t[2]];
    area_m2 += 0.5 * (b - a).cross(c - a).z();
  }
  return area_m2;
}

TEST(IrregularSheet, IsATriangulationOfTheSameNodesWithValences3To12) {
  const GwNetwork regular = regularSheet(40), irregular = irregularSheet(40);
  EXPECT_EQ(irregular.nodes(), 1600u);
  EXPECT_EQ(irregular.springs(), regular.springs());
  EXPECT_EQ(irregular.network().triangles.size(), regular.network().triangles.size());
  constexpr double kJittered = 0.02;  // share of the area: the nodes of the border were moved too
  EXPECT_NEAR(areaOf(irregular.network()) / areaOf(regular.network()), 1, kJittered);
  EXPECT_EQ(valencesOf(regular).most, 6u);
  EXPECT_EQ(valencesOf(irregular).most, 12u);
  EXPECT_LE(valencesOf(irregular).least, 3u);
}

TEST(HangingCloth, HasFourFixedNodes) {
  const GwNetwork cloth = hangingCloth(12);
  size_t fixed = 0;
  for (const layout::NodeBits& bits : cloth.body().lattice.nodes) fixed += isFixed(bits) ? 1 : 0;
  EXPECT_EQ(fixed, 4u);
}

/// The methods of gathering forces, on meshes that fill bricks and work groups and on meshes that do not.
class GwForces : public ::testing::TestWithParam<uint32_t> {
 protected:
  GwForces() : sheet(irregularSheet(GetParam())), kernels(sheet), u_m(deformed(sheet)) {
    for (Vector3d& u : u_m) u = u.cast<float>().cast<double>();
    truth_n = ReferenceLattice(sheet.model).elasticForces(u_m);
    kernels.start(u_m);
  }
  double error() const { return errorOf(sheet, kernels.forces(), truth_n).max; }
  double blendingError(BlendFormat format) {
    BlendTarget target(format, sheet.slots(), scaleOf(largestSum_n(sheet, u_m)));
    kernels.forceTexture();
    kernels.scatterForces(target);
    return errorOf(sheet, target.forces(), truth_n).max;
  }

  gpu::Context context;
  GwNetwork sheet;
  GwKernels kernels;
  Field u_m, truth_n;
};
INSTANTIATE_TEST_SUITE_P(Sheets, GwForces, ::testing::Values(3u, 8u, 9u, 33u));

TEST_P(GwForces, ArePointCentricAsInFloat64) {
  kernels.pointForces();
  EXPECT_LT(error(), kFloat);
}

TEST_P(GwForces, AreTheSameInAPassPerNeighbour) {
  kernels.pointForces();
  const Field once = kernels.forces();
  kernels.pointPasses();
  EXPECT_EQ(kernels.forces(), once);
}

TEST_P(GwForces, AreEdgeCentricAsInFloat64) {
  kernels.springForces();
  kernels.sumForces();
  EXPECT_LT(error(), kFloat);
}

TEST_P(GwForces, AddUpByBlendingAsWellAsTheTargetCan) {
  const double fixed8 = blendingError(BlendFormat::kFixed8), float16 = blendingError(BlendFormat::kFloat16);
  EXPECT_LT(blendingError(BlendFormat::kFloat32), kFloat);
  EXPECT_LT(float16, 0.01);
  EXPECT_LT(10 * kFloat, float16);
  EXPECT_LT(fixed8, 0.5);
  EXPECT_LT(float16, fixed8);
}

TEST(GwMotion, IsLeapfrogAsInFloat64) {
  const gpu::Context context;
  const GwNetwork cloth = hangingCloth(9);
  GwMotion motion;
  motion.dt_s = static_cast<double>(static_cast<float>(0.5 * safeTimeStep(cloth.model)));
  motion.gravity_m_per_s2 = Vector3d(1, 2, -8);
  ReferenceSolver truth(cloth.model, motion.gravity_m_per_s2, motion.dt_s);
  GwKernels wide(cloth), narrow(cloth, StateFormat::kFloat16);
  for (GwKernels* kernels : {&wide, &narrow}) kernels->start(Field(cloth.slots(), Vector3d::Zero()));
  for (int s = 0; s < kSubsteps; ++s) {
    truth.substep();
    for (GwKernels* kernels : {&wide, &narrow}) {
      kernels->pointForces();
      kernels->integrate(motion);
    }
  }
  EXPECT_LT(errorOf(cloth, wide.displacements(), truth.u_m).max, kMotion);
  const double halves = errorOf(cloth, narrow.displacements(), truth.u_m).max;
  EXPECT_GT(halves, 10 * kMotion);
  EXPECT_LT(halves, 0.05);
}

TEST(GwScale, LeavesRoomForTheLargestSum) {
  EXPECT_EQ(scaleOf(1), 2);
  EXPECT_EQ(scaleOf(0.9), 2);
  EXPECT_EQ(scaleOf(1.1), 4);
}

#ifdef VISCERA_HAS_COMMAND
/// Times are not checked, as the machine may be busy.
TEST(GwSuite, HasGwsTablesAndReachesItsErrorsInItsShortForm) {
  const test::TemporaryFolder folder;
  const test::Ending ending = test::runProgram(kCommand, {"bench", "gw", "--short", "--out", folder.path()});
  ASSERT_EQ(ending.status, 0) << ending.out << ending.err;
  const auto rows = [&](const std::string& table) {
    return test::linesOf(test::readFile(folder.file("gw_" + table + ".csv"))).size() - 1;
  };
  EXPECT_EQ(rows("costs"), 4u);           // two meshes, two methods
  EXPECT_EQ(rows("stages"), 4u);          // methods
  EXPECT_EQ(rows("valences"), 4u);        // methods
  EXPECT_EQ(rows("force_errors"), 12u);   // two meshes, six methods
  EXPECT_EQ(rows("motion_errors"), 36u);  // two scenes, six methods, three times
  size_t errors = 0;
  for (const std::string& line : test::linesOf(test::readFile(folder.file("gw_checks.csv")))) {
    if (!test::says(line, {"a force"})) continue;
    ++errors;
    EXPECT_TRUE(test::says(line, {",ok"})) << line;
  }
  EXPECT_EQ(errors, 4u);
}
#endif  // VISCERA_HAS_COMMAND

}  // namespace
}  // namespace viscera::bench
