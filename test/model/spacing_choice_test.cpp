// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "viscera/model/body/spacing_choice.h"

#include <cmath>

#include "body_samples.h"
#include "support/text.h"

namespace viscera::test {
namespace {

constexpr double kEdge_m = 0.1;     ///< edge of the cube
constexpr double kStart_m = 0.007;  ///< 15^3 cells
constexpr double kStepPerM = 0.05;  ///< stable step over spacing [s/m]: E = 20 kPa, halved
constexpr double kLeastLoad = 0.8;  ///< the rest is unused: one more layer of 13 cells is a quarter of the work

size_t cubeNodes(double spacing_m) {
  return static_cast<size_t>(std::pow(std::floor(kEdge_m / spacing_m + 1e-9) + 1, 3));
}

/// Returns the limits of a machine that steps this many nodes per second.
SpacingLimits limitsOf(double nodes_per_s, double overhead_s = 0) {
  SpacingLimits limits;
  limits.step = {overhead_s, 1 / nodes_per_s};
  limits.substeps_per_s = [](double spacing_m) { return 1 / (kStepPerM * spacing_m); };
  return limits;
}

SpacingChoice chosen(const SpacingLimits& limits) {
  return chooseSpacing(cubeNodes, kStart_m, limits);
}

double loadAt(double spacing_m, const SpacingLimits& limits) {
  return limits.substeps_per_s(spacing_m) *
         limits.step.of(static_cast<double>(cubeNodes(spacing_m) + limits.other_nodes)) / limits.stepping_share;
}

void expectFinest(const SpacingChoice& choice, const SpacingLimits& limits) {
  EXPECT_EQ(choice.bound, SpacingBound::kSpeed);
  EXPECT_EQ(choice.nodes, cubeNodes(choice.spacing_m) + limits.other_nodes);
  EXPECT_DOUBLE_EQ(choice.load, loadAt(choice.spacing_m, limits));
  EXPECT_LE(choice.load, 1);
  EXPECT_GE(choice.load, kLeastLoad);
}

TEST(SpacingChoice, IsTheFinestThatTheMachineSteps) {
  for (const double speed : {5e6, 3e7, 4e8, 2e9}) {
    const SpacingLimits limits = limitsOf(speed);
    expectFinest(chosen(limits), limits);
  }
}

TEST(SpacingChoice, SixteenTimesTheSpeedHalvesTheSpacing) {
  const double slow = chosen(limitsOf(5e7)).spacing_m, fast = chosen(limitsOf(16 * 5e7)).spacing_m;
  EXPECT_NEAR(slow / fast, 2, 0.1);  // nodes come in layers of the cube
}

TEST(SpacingChoice, TimeThatEverySubstepTakesCounts) {
  const SpacingLimits limits = limitsOf(1e9, 20e-6);
  expectFinest(chosen(limits), limits);
  EXPECT_GT(chosen(limits).spacing_m, 1.02 * chosen(limitsOf(1e9)).spacing_m);  // a fifth more work
}

TEST(SpacingChoice, SmallerShareAndOtherBodiesMakeItCoarser) {
  SpacingLimits half = limitsOf(4e8), crowded = limitsOf(4e8);
  half.stepping_share = 0.5;
  crowded.other_nodes = 30000;
  for (const SpacingLimits& limits : {half, crowded}) {
    expectFinest(chosen(limits), limits);
    EXPECT_GT(chosen(limits).spacing_m, 1.05 * chosen(limitsOf(4e8)).spacing_m);
  }
}

TEST(SpacingChoice, HasThreeDigits) {
  const double spacing_um = 1e6 * chosen(limitsOf(4e8)).spacing_m;  // between 1 and 10 mm
  EXPECT_NEAR(spacing_um / 10, std::round(spacing_um / 10), 1e-6);
}

TEST(SpacingChoice, DividesAnEdgeIntoWholeCellsWhereAsked) {
  SpacingLimits limits = limitsOf(4e8);
  limits.whole_m = kEdge_m;
  const double cells = kEdge_m / chosen(limits).spacing_m;
  EXPECT_NEAR(cells, std::round(cells), 1e-9);
  EXPECT_LE(chosen(limits).load, 1);
  EXPECT_GT(loadAt(kEdge_m / (cells + 1), limits), 1) << "one more cell would do";
  limits.finest_m = 0.0033;
  EXPECT_DOUBLE_EQ(chosen(limits).spacing_m, kEdge_m / 30);
}

TEST(SpacingChoice, KeepsToTheMostNodesAndToTheSolversLimit) {
  SpacingLimits few = limitsOf(1e12), coarse = limitsOf(1e12);
  few.most_nodes = 50000;
  EXPECT_EQ(chosen(few).bound, SpacingBound::kNodes);
  EXPECT_LE(chosen(few).nodes, few.most_nodes);
  EXPECT_GT(chosen(few).nodes, 0.8 * static_cast<double>(few.most_nodes));
  coarse.finest_m = 0.00312;
  EXPECT_EQ(chosen(coarse).bound, SpacingBound::kSolver);
  EXPECT_DOUBLE_EQ(chosen(coarse).spacing_m, 0.00312);
}

TEST(SpacingChoice, StaysClearOfLatticesThatDoNotFitInMemory) {
  constexpr double kFits_m = 0.0025;
  const auto nodes = [](double spacing_m) {
    if (spacing_m < kFits_m) throw LatticeError("too fine");
    return cubeNodes(spacing_m);
  };
  const SpacingChoice choice = chooseSpacing(nodes, kStart_m, limitsOf(1e12));
  EXPECT_EQ(choice.bound, SpacingBound::kMemory);
  EXPECT_GE(choice.spacing_m, kFits_m);
  EXPECT_LT(choice.spacing_m, 0.8 * kStart_m);
}

TEST(SpacingChoice, SlowMachineGetsACoarseLatticeAndANote) {
  const SpacingChoice choice = chosen(limitsOf(1e4));
  EXPECT_EQ(choice.bound, SpacingBound::kTooSlow);
  EXPECT_GT(choice.load, 1);
  EXPECT_LT(choice.nodes, 1000u);
  EXPECT_GT(choice.nodes, 100u);
}

TEST(SpacingChoice, IsNeverCoarserThanWallsAllow) {
  constexpr double kWall_m = 0.0042345;
  SpacingLimits slow = limitsOf(1e4), fast = limitsOf(4e8);
  slow.coarsest_m = fast.coarsest_m = kWall_m;
  EXPECT_EQ(chosen(slow).bound, SpacingBound::kWalls);
  EXPECT_LE(chosen(slow).spacing_m, kWall_m);
  EXPECT_GT(chosen(slow).spacing_m, 0.99 * kWall_m);
  EXPECT_GT(chosen(slow).load, 1);
  expectFinest(chosen(fast), fast);
  EXPECT_DOUBLE_EQ(chosen(fast).spacing_m, chosen(limitsOf(4e8)).spacing_m);
  slow.whole_m = kEdge_m;
  EXPECT_DOUBLE_EQ(chosen(slow).spacing_m, kEdge_m / 24);  // 23 cells would be coarser than the wall
}

TEST(SpacingChoice, CoarseLatticeWithoutACellIsNotTaken) {
  const auto nodes = [](double spacing_m) {
    if (spacing_m > 0.008) throw LatticeError("no cell inside");
    return cubeNodes(spacing_m);
  };
  const SpacingChoice choice = chooseSpacing(nodes, kStart_m, limitsOf(1e4));
  EXPECT_EQ(choice.bound, SpacingBound::kTooSlow);
  EXPECT_LE(choice.spacing_m, 0.008);
}

TEST(SpacingChoice, CountsNoMoreLatticesThanItMust) {
  int counts = 0;
  const auto nodes = [&](double spacing_m) {
    ++counts;
    return cubeNodes(spacing_m);
  };
  chooseSpacing(nodes, kStart_m, limitsOf(4e8));
  EXPECT_LE(counts, 6);  // two initially, then one, and corrections for whole layers
}

/// Returns a box with a spacing to be chosen and one of 5 mm.
Scene twoBodies() {
  Scene scene;
  scene.bodies = {boxConfig({0.04, 0.04, 0.04}, 0.004), boxConfig({0.02, 0.02, 0.02}, 0.005)};
  scene.bodies[0].auto_spacing = true;
  scene.bodies[1].name = "other";
  return scene;
}

TEST(UndividedBodies, CountWhatTheLatticesHave) {
  const UndividedBodies bodies(twoBodies());
  EXPECT_EQ(bodies.nodes(0.01), 125u);
  EXPECT_EQ(bodies.lattices(0.01).activeNodes(), 125u);
  ASSERT_EQ(bodies.lattices(0.01).bodies.size(), 1u);
  EXPECT_EQ(bodies.lattices(0.01).bodies[0].name, "slab");
  EXPECT_EQ(bodies.others().activeNodes(), 125u);
  EXPECT_EQ(bodies.others().bodies.at(0).name, "other");
  EXPECT_NEAR(static_cast<double>(bodies.nodes(bodies.spacingOf(4000))), 4000, 0.25 * 4000);
}

TEST(UndividedBodies, OfSeveralHaveOneSpacing) {
  Scene scene = twoBodies();
  scene.bodies[1].auto_spacing = true;
  const UndividedBodies bodies(scene);
  EXPECT_EQ(bodies.nodes(0.01), 125u + 27u);
  EXPECT_EQ(bodies.others().bodies.size(), 0u);
  scene.bodies[0].target_nodes = 1000;  // takes precedence
  EXPECT_EQ(UndividedBodies(scene).nodes(0.01), 27u);
}

TEST(UndividedBodies, BoxThatIsNotTurnedHasAnEdgeToDivide) {
  Scene scene = twoBodies();
  scene.bodies[0].box_size_m = {0.04, 0.07, 0.03};
  EXPECT_EQ(UndividedBodies(scene).wholeEdge_m(), 0.07);
  scene.bodies[0].rotation_deg = {0, 0, 30};
  EXPECT_EQ(UndividedBodies(scene).wholeEdge_m(), 0);
  scene.bodies[0] = phantomConfig(0.004);
  scene.bodies[0].auto_spacing = true;
  EXPECT_EQ(UndividedBodies(scene).wholeEdge_m(), 0);
}

TEST(UndividedBodies, NameTheBodyWhoseSpacingIsOutOfRange) {
  const UndividedBodies bodies(twoBodies());
  EXPECT_TRUE(says(messageOf<LatticeError>([&] { bodies.nodes(1); }), {"body 'slab'", "at most 0.04"}));
}

TEST(AutoSpacing, IsReadFromASceneAndFromAnOverride) {
  const auto parsed = [](const std::string& spacing, const Overrides& overrides) {
    return parseScene("bodies: [{name: a, spacing_m: " + spacing + "}, {name: b}]", "s.yaml", overrides);
  };
  EXPECT_EQ(autoBodies(parsed("auto", {})), std::vector<size_t>{0});
  EXPECT_EQ(autoBodies(parsed("0.003", {"bodies[1].spacing_m=auto"})), std::vector<size_t>{1});
  EXPECT_EQ(autoBodies(parsed("auto", {"bodies[0].spacing_m=0.002"})), std::vector<size_t>{});
  EXPECT_EQ(parsed("auto", {"bodies[0].spacing_m=0.002"}).bodies[0].spacing_m, 0.002);
  EXPECT_EQ(autoBodies(parsed("auto", {"bodies[0].target_nodes=900"})), std::vector<size_t>{});
  EXPECT_EQ(parsed("auto", {"solver.real_time_factor=3"}).solver.real_time_factor, 3);
}

TEST(AutoSpacing, OtherWordsAreRefusedWithWhatIsAccepted) {
  for (const char* value : {"automatic", "Auto", "[auto]", "", "-1", ".inf"}) {
    const std::string message = messageOf<SceneError>(
        [&] { parseScene(std::string("bodies:\n  - {name: a, spacing_m: ") + value + "}", "s.yaml"); });
    EXPECT_TRUE(
        says(message, {"s.yaml:2: ", "'bodies[0].spacing_m' must be a number, 1e-05 .. 10 m, or auto", "found"}));
  }
  EXPECT_TRUE(says(messageOf<SceneError>([] { parseScene("bodies: [{}]\nsolver: {real_time_factor: 0}", "s.yaml"); }),
                   {"'solver.real_time_factor' must be a number, 0.01 .. 1000"}));
}

TEST(AutoSpacing, WithoutASessionGivesAUsualNumberOfNodes) {
  BodyConfig config = boxConfig({0.05, 0.05, 0.05}, 0.01);
  config.auto_spacing = true;
  EXPECT_NEAR(static_cast<double>(build(config).lattice.active_slots.size()), kUnmeasuredNodes,
              0.02 * kUnmeasuredNodes);
}

TEST(AutoSpacing, NoteSaysWhyTheSpacingIsWhatItIs) {
  BodyConfig config = boxConfig({0.05, 0.05, 0.05}, 0.01);
  config.spacing_note = "chosen by lot";
  EXPECT_EQ(build(config).notes.at(0), "chosen by lot");
}

}  // namespace
}  // namespace viscera::test
