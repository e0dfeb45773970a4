// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "viscera/calibration/auto_spacing.h"

#include <gtest/gtest.h>

#include <cmath>

#include "math/processors.h"
#include "session/block_session.h"
#include "solver/make_solver.h"
#include "solver/ticks/stable_step.h"
#include "solver/tissue/substeps.h"
#include "support/gpu_fixture.h"
#include "support/text.h"
#include "viscera/math/error.h"
#include "viscera/solver/stability_monitor.h"

namespace viscera {
namespace {

using namespace test;

constexpr StepTime kMachine{5e-7, 4e-9};  ///< 250 M nodes/s once busy: fixed, so that the choice is always the same
constexpr double kMostLoad = 1.02;  ///< the number of substeps is an integer, and its rule comes from a coarse lattice

/// The block of other tests with spacing_m: auto, on a machine of known speed.
class AutoSpacing : public GpuTest {
 protected:
  AutoSpacing() {
    scene_.bodies[0].auto_spacing = true;
    scene_.solver.backend = Backend::kCpu;
  }
  Scene chosen() { return withChosenSpacing(scene_, &context_, {}, kMachine); }
  double chosenSpacing_m() { return chosen().bodies[0].spacing_m; }
  double share() { return shareOfSteps(scene_, context_.isSoftware(), static_cast<unsigned>(usableProcessors())); }

  Scene scene_ = blockScene();
};

/// Returns the clock time for one second of a scene on the known machine, while the tissue is strained [s]. If the
/// limit of the substep is measured, takes as many substeps as it requires.
double seconds(const Scene& scene) {
  const Model model = buildModel(scene);
  const SubstepPlan plan = planSubsteps(model, scene.solver, safeTimeStep(model));
  double per_tick = std::max(plan.calm, plan.strained);
  if (measuresLimit(model, scene.solver)) {
    const double limit_s = makeSolver(model, scene, nullptr)->dtLimit_s();
    const double dt_s =
        measuredSubstep_s(scene.solver, largestDashpot(model), safeTimeStep(model), limit_s, kStrainedStretch);
    per_tick = std::ceil(1 / (scene.solver.tick_hz * dt_s));
  }
  return per_tick * scene.solver.tick_hz * kMachine.of(static_cast<double>(model.activeNodes()));
}

TEST_F(AutoSpacing, IsTheFinestLatticeThatTheMachineStepsInTime) {
  const Scene scene = chosen();
  EXPECT_FALSE(scene.bodies[0].auto_spacing);
  const double load = seconds(scene) * scene.solver.real_time_factor / share();
  EXPECT_LT(load, kMostLoad);
  EXPECT_GT(load, 0.8);  // the block has some 20 layers: one more means a sixth more nodes
}

TEST(ShareOfSteps, LeavesASoftwareRasteriserWhatTenPicturesASecondTake) {
  Scene scene;
  EXPECT_EQ(shareOfSteps(scene, true, 2), 0.8) << "no camera";
  scene.cameras.resize(1);
  EXPECT_EQ(shareOfSteps(scene, false, 2), 0.8);
  EXPECT_NEAR(shareOfSteps(scene, true, 2), 0.4, 1e-9);
  EXPECT_EQ(shareOfSteps(scene, true, 16), 0.8);
  scene.cameras[0].width_px *= 4;
  EXPECT_EQ(shareOfSteps(scene, true, 2), 0.25);
}

TEST_F(AutoSpacing, IsFinerWhereSubstepsAreMeasured) {
  Scene proven = scene_;
  proven.solver.measured_limit = false;
  const Scene without = withChosenSpacing(proven, &context_, {}, kMachine), with = chosen();
  EXPECT_LT(with.bodies[0].spacing_m, 0.92 * without.bodies[0].spacing_m);  // substeps 1.8 times as long: 1.8^(-1/4)
  EXPECT_LT(seconds(without), kMostLoad * share() / scene_.solver.real_time_factor);
}

TEST_F(AutoSpacing, FollowsTheFactorTheStiffnessAndTheCameras) {
  scene_.cameras[0].width_px = 640;
  scene_.cameras[0].height_px = 480;
  const double usual_m = chosenSpacing_m(), beside_pictures = share();
  EXPECT_EQ(chosenSpacing_m(), usual_m);
  scene_.solver.real_time_factor *= 16;
  EXPECT_NEAR(chosenSpacing_m(), 2 * usual_m, 0.2 * usual_m);
  scene_.solver.real_time_factor /= 16;
  scene_.bodies[0].material.young_modulus_pa *= 9;  // makes three times as many substeps
  EXPECT_NEAR(chosenSpacing_m(), std::pow(3, 0.25) * usual_m, 0.1 * usual_m);
  scene_.bodies[0].material.young_modulus_pa /= 9;
  scene_.cameras.clear();
  EXPECT_NEAR(chosenSpacing_m(), std::pow(beside_pictures / share(), 0.25) * usual_m, 0.05 * usual_m);
}

TEST_F(AutoSpacing, NoteTellsTheChoiceAndWhy) {
  const std::string note = chosen().bodies[0].spacing_note;
  EXPECT_TRUE(says(note, {"spacing_m: auto: 0.00", " nodes, at most ", " substeps per second", " M nodes/s",
                          "of 1.2 wanted: the finest that"}));
  EXPECT_EQ(note.find('\n'), std::string::npos);
}

TEST_F(AutoSpacing, IsAcceptedByTheSolverWhereItsLimitsDecide) {
  scene_.solver.real_time_factor = 0.01;
  scene_.solver.max_substeps = 40;
  Scene scene = chosen();
  EXPECT_TRUE(says(scene.bodies[0].spacing_note, {"solver.max_substeps"}));
  const Model model = buildModel(scene);
  EXPECT_GE(planSubsteps(model, scene.solver, safeTimeStep(model)).strained, 34);  // for one cell less; throws above 40
  scene_.solver.substeps = 30;
  scene = chosen();
  const Model given = buildModel(scene);
  EXPECT_EQ(planSubsteps(given, scene.solver, safeTimeStep(given)).calm, 30);  // throws if not stable
  EXPECT_LT(1 / (30 * scene.solver.tick_hz), safeTimeStep(given));
}

TEST_F(AutoSpacing, IsNoCoarserThanTheWallsOfThePhantomHoweverSlowTheMachine) {
  scene_.bodies[0].source = TissueSource::kPhantom;
  scene_.bodies[0].material.law = Law::kSprings;
  scene_.solver.real_time_factor = 1000;
  const Scene scene = chosen();
  EXPECT_NEAR(scene.bodies[0].spacing_m, 0.042 * scene.bodies[0].phantom_length_m, 1e-9);
  EXPECT_TRUE(says(scene.bodies[0].spacing_note, {"thinnest wall", "too slow", "phantom_wall_scale"}));
}

TEST_F(AutoSpacing, MayBeCoarserThanWallsOfCellsThatAreTissueInPart) {
  scene_.bodies[0].source = TissueSource::kPhantom;
  scene_.solver.real_time_factor = 1000;
  const Scene scene = chosen();
  EXPECT_GT(scene.bodies[0].spacing_m, 0.042 * scene.bodies[0].phantom_length_m);
  EXPECT_FALSE(says(scene.bodies[0].spacing_note, {"thinnest wall"}));
}

TEST_F(AutoSpacing, OfSeveralBodiesIsOneAndOthersKeepTheirs) {
  scene_.bodies.resize(3, scene_.bodies[0]);
  scene_.bodies[1].name = "second";
  scene_.bodies[2].name = "third";
  scene_.bodies[2].auto_spacing = false;
  const double alone_m = chosenSpacing_m();
  const Scene scene = chosen();
  EXPECT_EQ(scene.bodies[0].spacing_m, scene.bodies[1].spacing_m);
  EXPECT_EQ(scene.bodies[2].spacing_m, scene_.bodies[2].spacing_m);
  EXPECT_TRUE(scene.bodies[1].spacing_note.empty());
  scene_.bodies[2].spacing_m /= 4;  // leaves less for the two others
  EXPECT_GT(chosenSpacing_m(), alone_m);
}

TEST_F(AutoSpacing, SceneWithoutItComesBackAsItIsAndNothingIsMeasured) {
  scene_.bodies[0].auto_spacing = false;
  int stages = 0;
  const Scene scene = withChosenSpacing(scene_, &context_, [&](const std::string&, double) { ++stages; });
  EXPECT_EQ(scene.bodies[0].spacing_m, scene_.bodies[0].spacing_m);
  EXPECT_EQ(stages, 0);
}

TEST_F(AutoSpacing, EveryBackendCanBeMeasured) {
  const UndividedBodies bodies(scene_);
  for (const Backend backend : {Backend::kCpu, Backend::kGpu}) {
    scene_.solver.backend = backend;
    EXPECT_GT(measureStepTime(bodies, scene_, &context_).of(1000), 0);
  }
}

TEST_F(AutoSpacing, NeedsNoContextWhereTheCpuSteps) {
  scene_.solver.backend = Backend::kCpu;
  EXPECT_GT(measureStepTime(UndividedBodies(scene_), scene_, nullptr).of(1000), 0);
}

TEST_F(AutoSpacing, SessionHasTheLatticeThatWasChosen) {
  scene_.solver.real_time_factor = 400;
  Session session(scene_, context_);
  const double spacing_m = session.model().bodies[0].lattice.spacing_m;
  EXPECT_EQ(spacing_m, session.scene().bodies[0].spacing_m);
  EXPECT_TRUE(says(session.model().bodies[0].notes.at(0), {"spacing_m: auto"}));
  EXPECT_TRUE(std::isfinite(session.step({}, {}).health.kinetic_j));
}

}  // namespace
}  // namespace viscera
