// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
// Sutures through tissue, on both backends.
#include "math/archive.h"
#include "solver/processes/suture/stitch.h"
#include "solver/processes/suture/suture_bodies.h"
#include "viscera/math/error.h"

using namespace viscera;
using namespace viscera::test;

namespace {

constexpr double kTick_s = 1.0 / 60;
constexpr double kStitchMomentum = 1e-6;  // of the momentum that suture and tissue exchanged
constexpr double kFloat_m = 1e-8;         // float32 against itself in another order, after some ticks
constexpr double kLink = 1e-3;
constexpr double kLips_m = 2e-4;  // largest overlap of lips that are pressed together

class Stitch : public OnBackend {
 protected:
  const Model model_ = modelOf({stitchBox()});
};

INSTANTIATE_TEST_SUITE_P(Backends, Stitch, ::testing::ValuesIn(backendKinds()), backendSuffix);

uint64_t hashOf(const Model& model, const TissueStepper& solver) {
  return hashWith(stateHash(model, solver.readState()), *findProcess<SutureBodies>(solver));
}

/// Returns the momentum of all free nodes.
Vector3d momentumOf(const Model& model, const TissueStepper& solver) {
  const HostState state = solver.readState();
  const Body& body = model.bodies[0];
  const std::vector<float> masses = strengths(body).mass_kg;
  Vector3d out = Vector3d::Zero();
  for (const uint32_t slot : body.lattice.active_slots)
    out += static_cast<double>(masses[slot]) * xyz(state.velocity_m_per_s[slot]);
  const Chain& chain = findProcess<SutureBodies>(solver)->chain(0);
  for (size_t i = 0; i < chain.nodes(); ++i) out += chain.mass_kg(i) * chain.velocities_m_per_s()[i];
  return out;
}

}  // namespace

TEST_P(Stitch, ClosesASlitThatIsPulledApart) {
  const auto solver = make(model_, stitchScene());
  pullApart(*solver, model_.bodies[0], 1.5e-3);
  for (int t = 0; t < 20; ++t) solver->step({});
  const Gap before = gapOf(*solver, model_.bodies[0]);
  EXPECT_GT(before.mean_m, 2e-3);
  StitchTool tool(0.012);
  const int ticks = GetParam() == "gpu" ? 40 : 60;
  double felt_n = 0;
  for (int t = 0; t < ticks; ++t) {
    solver->step(tool.next(*solver, kTick_s));
    felt_n = std::max(felt_n, xyz(lastStats(*solver).impulse[0]).norm() / kTick_s);
    ASSERT_LT(findProcess<SutureBodies>(*solver)->chain(0).worstLink(), kLink) << t;
  }
  const Gap after = gapOf(*solver, model_.bodies[0]);
  EXPECT_LT(after.mean_m, 0.5 * before.mean_m);
  EXPECT_GT(after.least_m, -kLips_m);
  EXPECT_NEAR(felt_n, 0.1, 0.02);  // the limit of the stylus
  EXPECT_EQ(solver->health().trips, 0U);
}

TEST_P(Stitch, KeepsMomentumOfSutureAndTissue) {
  Body body = slitBox();
  for (layout::NodeBits& bits : body.lattice.nodes) bits.lo &= ~layout::kFixedBit;
  body.material.mass_damping_per_s = 0;
  const Model model = modelOf({body});
  Scene scene = stitchScene();
  scene.sutures[0].start = SutureEnd::kFree;
  scene.sutures[0].mass_damping_per_s = 0;
  scene.sutures[0].channels.resize(3);
  scene.solver.sleep_speed_m_per_s = 0;
  const auto solver = make(model, scene);
  HostState state = solver->readState();
  for (const uint32_t slot : body.lattice.active_slots)
    state.velocity_m_per_s[slot].y = 0.1f;  // draws the suture along
  solver->writeState(state);
  const Vector3d before = momentumOf(model, *solver);
  for (int t = 0; t < 20; ++t) solver->step({});
  EXPECT_GT(findProcess<SutureBodies>(*solver)->chain(0).velocities_m_per_s()[40].norm(), 0.01);
  EXPECT_LT((momentumOf(model, *solver) - before).norm(), kStitchMomentum * before.norm());
}

TEST_P(Stitch, GoesOnToTheBitFromASavedState) {
  const auto one = make(model_, stitchScene()), two = make(model_, stitchScene());
  pullApart(*one, model_.bodies[0], 1.5e-3);
  StitchTool tool(0.012);
  for (int t = 0; t < 10; ++t) one->step(tool.next(*one, kTick_s));
  Archive saved;
  one->persist(saved);
  Archive read(saved.sections());
  two->persist(read);
  read.end();
  EXPECT_EQ(hashOf(model_, *one), hashOf(model_, *two));
  for (int t = 0; t < 5; ++t) {
    const ToolMotions motions = tool.next(*one, kTick_s);
    one->step(motions);
    two->step(motions);
  }
  EXPECT_EQ(hashOf(model_, *one), hashOf(model_, *two));
  two->reset();
  EXPECT_EQ(hashOf(model_, *two), hashOf(model_, *make(model_, stitchScene())));
}

/// Returns a blade that cuts the tissue next to the tracks in ticks 2 to 7. The other stylus holds tissue, and has no
/// valid pose in some ticks, which the stability monitor rolls back: while the blade is there, right after it, and
/// later.
ToolMotions cutAndLose(int tick) {
  constexpr double kX_m = 0.0135, kLength_m = 0.0145, kBelow_m = -0.001;
  constexpr int kFirst = 2, kLast = 7;
  const auto at = [&](int t) { return Vector3d(kX_m, kLength_m * (t - kFirst) / (kLast + 1 - kFirst), kBelow_m); };
  ToolMotions out;
  if (tick >= kFirst && tick <= kLast) out[0] = motionOf(ToolMode::kCut, at(tick), at(tick + 1));
  const Vector3d hold_m(0.003, 0.003, 0.009);
  out[1] = motionOf(ToolMode::kGrab, hold_m, hold_m);
  out[1].hold_begins = tick == 0;
  for (const int lost : {4, kLast + 1, kLast + 2, 14}) {
    if (tick == lost) out[1].to.position_m.x() = std::numeric_limits<double>::quiet_NaN();
  }
  return out;
}

TEST_P(Stitch, GoesOnToTheBitFromEveryTickAlsoAfterRollbacks) {
  constexpr int kTicks = 20, kGoesOn = 2;
  Scene scene = stitchScene();
  scene.styluses.emplace_back();
  const auto unbroken = make(model_, scene), resumed = make(model_, scene);
  std::vector<Archive> saved(kTicks);
  std::vector<uint64_t> hashes;
  for (int t = 0; t < kTicks; ++t) {
    unbroken->step(cutAndLose(t));
    unbroken->persist(saved[static_cast<size_t>(t)]);
    hashes.push_back(hashOf(model_, *unbroken));
  }
  EXPECT_GE(unbroken->health().trips, 3U);  // on the GPU the tick after a bad one does not count
  for (int t = 0; t + kGoesOn < kTicks; ++t) {
    Archive read(saved[static_cast<size_t>(t)].sections());
    resumed->reset();
    resumed->persist(read);
    read.end();
    for (int next = t + 1; next <= t + kGoesOn; ++next) {
      resumed->step(cutAndLose(next));
      EXPECT_EQ(hashOf(model_, *resumed), hashes[static_cast<size_t>(next)]) << next << ", saved after " << t;
    }
  }
}

TEST_P(Stitch, IsTheSameOnEveryBackendAndForAnyNumberOfThreads) {
  constexpr int kTicks = 4;
  Scene scene = stitchScene();
  scene.solver.measured_limit = false;  // the GPU knows the stretch of the tissue later
  scene.solver.dt_fraction = scene.solver.dt_fraction_strained = 0.5;
  const auto ticked = [&](TissueStepper& solver) {
    pullApart(solver, model_.bodies[0], 1.5e-3);
    StitchTool tool(0.012);
    for (int t = 0; t < kTicks; ++t) solver.step(tool.next(solver, kTick_s));
  };
  const auto solver = make(model_, scene);
  const auto one = makeCpu(simdTargets().front(), model_, scene, 1);
  ticked(*solver);
  ticked(*one);
  const HostState a = solver->readState(), b = one->readState();
  for (const uint32_t slot : model_.bodies[0].lattice.active_slots)
    EXPECT_LT((xyz(a.displacement_m[slot]) - xyz(b.displacement_m[slot])).norm(), kFloat_m);
  if (GetParam() == "gpu") return;
  for (const int threads : {2, 8}) {
    const auto many = makeCpu(simdTargets().front(), model_, scene, threads);
    ticked(*many);
    EXPECT_EQ(hashOf(model_, *many), hashOf(model_, *one)) << threads;
  }
}

TEST_P(Stitch, HoldsWithPdWhoseSubstepsAreLonger) {
  Scene scene = stitchScene();
  scene.solver.integrator = Integrator::kPd;
  scene.solver.iterations = 5;
  const auto solver = make(model_, scene);
  pullApart(*solver, model_.bodies[0], 1.5e-3);
  for (int t = 0; t < 3; ++t) solver->step({});
  const Gap before = gapOf(*solver, model_.bodies[0]);
  StitchTool tool(0.012);
  for (int t = 0; t < 15; ++t) solver->step(tool.next(*solver, kTick_s));
  EXPECT_LT(gapOf(*solver, model_.bodies[0]).mean_m, 0.95 * before.mean_m);
  EXPECT_LT(findProcess<SutureBodies>(*solver)->chain(0).worstLink(), kLink);
  EXPECT_EQ(solver->health().trips, 0U);
}

TEST_P(Stitch, TearsOutOfTissueThatItPullsTooHard) {
  Scene scene = stitchScene(0.5);
  scene.sutures[0].pull_out_n = 0.02;
  const auto solver = make(model_, scene);
  solver->step({});
  const uint32_t before = lastStats(*solver).springs_cut;
  StitchTool tool(0.03);
  const int ticks = 90;
  for (int t = 0; t < ticks; ++t) solver->step(tool.next(*solver, kTick_s));
  EXPECT_LT(findProcess<SutureBodies>(*solver)->chain(0).worstLink(), kLink);
  EXPECT_GT(lastStats(*solver).springs_cut, before);
  EXPECT_LT(findProcess<SutureBodies>(*solver)->slides(0).size(), 6U);
  EXPECT_TRUE(isFinite(solver->readState()));
  EXPECT_EQ(solver->health().trips, 0U);
}

TEST(StitchScene, NamesWhatIsWrongWithATrack) {
  const Model model = modelOf({slitBox()});
  const auto fault = [&](const std::function<void(SutureConfig&)>& change) {
    Scene scene = stitchScene();
    change(scene.sutures[0]);
    try {
      SutureBodies sutures(scene, &model);
    } catch (const SceneError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  const auto expect = [&](const char* what, const std::function<void(SutureConfig&)>& change) {
    EXPECT_NE(fault(change).find(what), std::string::npos) << fault(change);
  };
  EXPECT_EQ(fault([](SutureConfig&) {}), "");
  expect("channels[0]: there is no body 'lung'", [](SutureConfig& suture) { suture.channels[0].body = "lung"; });
  expect("channels[6]: there is no tissue of body 'box'", [](SutureConfig& suture) {
    suture.channels.push_back({"box", inStitch(17, 13)});
  });
  expect("channels[2]: its suture passes at a distance of",
         [](SutureConfig& suture) { suture.channels[2].position_m = inStitch(15, 5); });
  expect("channels[1]: does not follow the previous channel",
         [](SutureConfig& suture) { std::swap(suture.channels[0], suture.channels[1]); });
  expect("channels[1]: is", [](SutureConfig& suture) { suture.channels[1].position_m = inStitch(12, 8.2); });
}
