// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>

#include "solver/reference/reference_ticks.h"
#include "support/backends.h"
#include "viscera/tools/tools.h"

using namespace viscera;
using namespace viscera::test;

namespace {

constexpr double kFloat32 = 1e-4;  // relative to the largest displacement
constexpr int kSuctionSubsteps = 20, kSuctionTicks = 30;
constexpr double kPull_m = 2e-4;  // per tick
const Vector3d kTop_m(0.03, 0.03, 0.06);

/// A block on a table, and a stylus with suction at the middle of its top by button 1.
class Suction : public OnBackend {
 protected:
  Suction() : model_(modelOf({boxBody({6, 6, 6}, 0.01)})) {
    for (uint32_t slot : lattice().active_slots) {
      if (lattice().nodeAt(slot).z() == 0) model_.bodies[0].lattice.nodes[slot].lo |= layout::kFixedBit;
    }
  }
  const Lattice& lattice() const { return model_.bodies[0].lattice; }
  Scene sceneWith(double max_force_n) const {
    StylusConfig stylus;
    stylus.idle = ToolMode::kNone;
    stylus.button1 = ToolMode::kSuction;
    stylus.suction.radius_m = 0.012;
    stylus.suction.max_force_n = max_force_n;
    return sceneFor(model_, kSuctionSubsteps, {stylus});
  }
  /// Returns the stylus in a tick: button 1 pressed, pulling upwards.
  static StylusSamples pull(int tick, bool pressed = true) {
    StylusSamples samples;
    samples[0].valid = true;
    samples[0].pose.position_m = kTop_m + kPull_m * tick * Vector3d::UnitZ();
    samples[0].button1 = pressed;
    return samples;
  }
  /// Returns the force on the stylus in each tick of a pull without limit [N].
  std::vector<double> forces() const {
    const Scene scene = sceneWith(1e3);
    ReferenceTicks reference(model_, scene);
    Tools tools(scene.styluses);
    std::vector<double> out;
    for (int t = 0; t < kSuctionTicks; ++t) {
      reference.step(tools.advance(pull(t)));
      out.push_back(reference.impulse(0).norm() * scene.solver.tick_hz);
    }
    return out;
  }
  /// Returns a limit that the pull exceeds for the first time after `tick` [N], with a margin over rounding.
  double limitThatGivesWayIn(int& tick) const {
    const std::vector<double> force = forces();
    const double half = 0.5 * *std::max_element(force.begin(), force.end());
    tick = 0;
    while (force[static_cast<size_t>(tick)] <= half) ++tick;
    const double before = *std::max_element(force.begin(), force.begin() + tick);
    EXPECT_GT(force[static_cast<size_t>(tick)], 1.01 * before);
    return 0.5 * (force[static_cast<size_t>(tick)] + before);
  }
  static size_t held(const std::vector<layout::NodeBits>& nodes) {
    return static_cast<size_t>(std::count_if(nodes.begin(), nodes.end(),
                                             [](layout::NodeBits bits) { return (bits.lo & layout::kGrabMask) != 0; }));
  }

  Model model_;
};

INSTANTIATE_TEST_SUITE_P(Backends, Suction, ::testing::ValuesIn(backendNames()), backendSuffix);

}  // namespace

TEST_P(Suction, HoldsBelowItsLimitAndLetsGoAboveItLikeTheReference) {
  int last = 0;
  const Scene scene = sceneWith(limitThatGivesWayIn(last));
  ASSERT_GT(last, 3);
  ASSERT_LT(last, kSuctionTicks - 3);
  const auto solver = make(model_, scene);
  ReferenceTicks reference(model_, scene);
  Tools tools(scene.styluses);
  for (int t = 0; t < kSuctionTicks; ++t) {
    const ToolMotions motions = tools.advance(pull(t));
    solver->step(motions);
    reference.step(motions);
    EXPECT_EQ(held(reference.solver().nodes) > 0, t < last) << "tick " << t;
    EXPECT_EQ(held(solver->readState().nodes), held(reference.solver().nodes)) << "tick " << t;
  }
  EXPECT_LT(relativeError(solver->readState().displacement_m, reference.solver().u_m, reference.solver().active),
            kFloat32);
}

TEST_P(Suction, WithoutAForceAboveItsLimitItHoldsLikeAGrab) {
  Scene scene = sceneWith(1e3);
  const auto suction = make(model_, scene);
  Tools sucking(scene.styluses);
  scene.styluses[0].button1 = ToolMode::kGrab;
  scene.styluses[0].grab.radius_m = scene.styluses[0].suction.radius_m;
  const auto grab = make(model_, scene);
  Tools grabbing(scene.styluses);
  for (int t = 0; t < kSuctionTicks; ++t) {
    suction->step(sucking.advance(pull(t, t < kSuctionTicks - 2)));
    grab->step(grabbing.advance(pull(t, t < kSuctionTicks - 2)));
    EXPECT_EQ(held(suction->readState().nodes) > 0, t < kSuctionTicks - 2);
  }
  EXPECT_EQ(stateHash(model_, suction->readState()), stateHash(model_, grab->readState()));
}

TEST_P(Suction, HoldsNothingAfterItLetGoUntilTheButtonIsPressedAgainEvenUnderTheGovernor) {
  int last = 0;
  Scene scene = sceneWith(limitThatGivesWayIn(last));
  scene.solver.stability_monitor = true;
  const auto solver = make(model_, scene);
  Tools tools(scene.styluses);
  for (int t = 0; t < kSuctionTicks; ++t) solver->step(tools.advance(pull(t)));
  EXPECT_EQ(held(solver->readState().nodes), 0u);
  solver->step(tools.advance(pull(0)));  // back at the tissue, the button still pressed
  EXPECT_EQ(held(solver->readState().nodes), 0u);
  solver->step(tools.advance(pull(0, false)));
  solver->step(tools.advance(pull(0)));
  EXPECT_GT(held(solver->readState().nodes), 0u);
  EXPECT_EQ(solver->health().trips, 0u);
}
