// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// External effects on held nodes act on the tool that holds them: momentum is conserved.
#include "support/loose_cloth.h"
#include "support/momentum.h"
#include "support/solver_rig.h"

using namespace viscera;
using namespace viscera::test;

namespace {

constexpr double kHeldReactionSpacing_m = 0.01;
constexpr int kNodes = 6;  ///< along an edge of a cloth
/// Of the exchanged momentum: float32 sums over some thousand contacts.
constexpr double kRounding = 1e-4;

StylusConfig wideGrip() {
  StylusConfig out;
  out.grab.radius_m = kNodes * kHeldReactionSpacing_m;
  return out;
}

ToolMotions holding(bool begins) {
  ToolMotions out = tool(ToolMode::kGrab, Vector3d::Zero(), Vector3d::Zero());
  out[0].hold_begins = begins;
  return out;
}

class HeldReaction : public OnSolver {
 protected:
  /// Holds a cloth in z = 0 with all its nodes, in place. Returns the momentum given by the tool.
  Vector3d given(const Model& model, const Scene& scene, const HostState& state, int ticks) {
    solver_ = make(model, scene);
    solver_->writeState(state);
    Vector3d sum = Vector3d::Zero();
    layout::TickStats stats;
    for (int t = 0; t < ticks; ++t) {
      solver_->step(holding(t == 0));
      while (solver_->pollStats(stats, true)) sum += xyz(stats.impulse[0]);
    }
    EXPECT_EQ(stats.grabbed[0], static_cast<uint32_t>(kNodes * kNodes));
    return sum;
  }
  std::unique_ptr<TissueStepper> solver_;
};

INSTANTIATE_TEST_SUITE_P(Backends, HeldReaction, solversUnderTest({Integrator::kLeapfrog, Integrator::kPd}),
                         solverSuffix);

}  // namespace

TEST_P(HeldReaction, AClothThatFallsOnAHeldOneIsStoppedByTheTool) {
  constexpr double kHeight_m = 0.1, kSpeed_m_per_s = 2;
  const Model model =
      modelOf({looseCloth(kNodes, kNodes, kHeldReactionSpacing_m), looseCloth(kNodes, kNodes, kHeldReactionSpacing_m)});
  Scene scene = sceneFor(model, 10, {wideGrip()});
  scene.collision.enabled = true;
  HostState state = restState(model);
  place(model, 1, {Vector3d(0, 0, kHeight_m), Quaterniond::Identity()}, Vector3d(0.1, 0, -kSpeed_m_per_s), state);
  const Vector3d before = momentum(model, state);
  const double tick_s = 1 / scene.solver.tick_hz;
  const int ticks = static_cast<int>(1.5 * kHeight_m / kSpeed_m_per_s / tick_s);
  const Vector3d sum = given(model, scene, state, ticks);
  const Vector3d after = momentum(model, solver_->readState());
  ASSERT_GT(after.z(), 0.5 * before.z());  // it has met the other
  EXPECT_LT((after - before - sum).norm(), kRounding * before.norm()) << sum.transpose();
}

TEST_P(HeldReaction, AToolHoldsAClothAgainstAForceOnIt) {
  Body body = looseCloth(kNodes, kNodes, kHeldReactionSpacing_m);
  body.force_n = Vector3d(0.1, -0.2, 0.3);
  const Model model = modelOf({body});
  const Scene scene = sceneFor(model, 10, {wideGrip()});
  constexpr int kTicks = 5;
  const Vector3d sum = given(model, scene, restState(model), kTicks);
  const Vector3d wanted = -body.force_n * kTicks / scene.solver.tick_hz;
  EXPECT_LT((sum - wanted).norm(), kRounding * wanted.norm()) << sum.transpose();
}

TEST_P(HeldReaction, AToolHoldsAClothAgainstTheWind) {
  const Model model = modelOf({looseCloth(kNodes, kNodes, kHeldReactionSpacing_m)});
  Scene scene = sceneFor(model, 10, {wideGrip()});
  WindConfig& wind = scene.environment.wind;
  wind.velocity_m_per_s = Vector3d(0, 0, 3);
  double area_m2 = 0;
  const SpringNetwork& network = *model.bodies[0].network;
  for (const std::array<uint32_t, 3>& t : network.triangles) {
    const auto at = [&](size_t i) { return network.positions_m[t[i]]; };
    area_m2 += 0.5 * (at(1) - at(0)).cross(at(2) - at(0)).norm();
  }
  constexpr int kTicks = 5;
  const Vector3d sum = given(model, scene, restState(model), kTicks);
  const double pressure_pa = 0.5 * wind.air_density_kg_per_m3 * wind.drag_coefficient * 3 * 3;
  const Vector3d wanted(0, 0, -pressure_pa * area_m2 * kTicks / scene.solver.tick_hz);
  EXPECT_LT((sum - wanted).norm(), kRounding * wanted.norm()) << sum.transpose() << " / " << wanted.transpose();
}
