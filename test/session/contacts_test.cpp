// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>

#include "session/block_session.h"
#include "solver/processes/blade/blades.h"

namespace viscera {
namespace {

using test::leftAt;

/// Makes some ticks in which the tip moves into the block from above and stays there.
TickContact pressedContact(Session& session) {
  constexpr double kAbove_m = test::kHalfM + test::kProbeRadiusM + 0.002, kDeep_m = 0.005;
  Frame frame;
  for (int tick = 0; tick < 40; ++tick) {
    const double offset = std::min(tick / 20.0, 1.0);
    frame = session.step(leftAt({0, 0, kAbove_m - offset * kDeep_m}), {});
  }
  return frame.contacts[0];
}

Scene scene() {
  Scene out = test::blockScene();
  out.solver.backend = Backend::kCpu;
  return out;
}

TEST(Contacts, GoOnFromTickToTick) {
  Session session(scene());
  const TickContact pressed = pressedContact(session);
  EXPECT_EQ(pressed.kind, TickContact::Kind::kPushes);
  EXPECT_FALSE(pressed.anew);
}

/// The previous surface is no surface now: its plane must not be felt.
TEST(Contacts, BeginAgainWithAResetAnotherToolAndAnotherMode) {
  Session session(scene());
  pressedContact(session);
  session.reset();
  session.resetInput();
  EXPECT_TRUE(session.step(leftAt({0, 0, 0.1}), {}).contacts[0].anew);
  pressedContact(session);
  session.setToolMode(0, ToolSwitch::kIdle, ToolMode::kNone);
  EXPECT_TRUE(session.step(leftAt({0, 0, 0.03}), {}).contacts[0].anew);
  session.setToolMode(0, ToolSwitch::kIdle, ToolMode::kProbe);
  pressedContact(session);
  EXPECT_TRUE(session.step({}, {}).contacts[0].anew);
  EXPECT_TRUE(session.step(leftAt({0, 0, 0.03}), {}).contacts[0].anew);
}

TEST(Contacts, OfBladesThatTissueResistsHaveTheForceAtWhichItParts) {
  constexpr double kToughness_j_per_m2 = 50, kBlade_m = 0.02, kShare = 0.1;
  Scene resists = scene();
  resists.bodies[0].material.cut.toughness_j_per_m2 = kToughness_j_per_m2;
  resists.styluses[0].idle = ToolMode::kCut;
  resists.styluses[0].cut.blade_length_m = kBlade_m;
  Session session(resists);
  Frame frame;
  for (int tick = 0; tick < 35; ++tick) frame = session.step(leftAt({-0.03 + 0.001 * tick, 0.001, -0.005}), {});
  const double force_n = kToughness_j_per_m2 * kBlade_m;
  EXPECT_NEAR(frame.reactions[0].force_n.x(), -force_n, kShare * force_n);
  EXPECT_EQ(frame.contacts[0].kind, TickContact::Kind::kPushes);
  EXPECT_NEAR(frame.contacts[0].limit_n, force_n, kShare * force_n);
  EXPECT_GT(frame.stats.springs_cut, 0u);
  EXPECT_GT(bladeWork(session.solver(), 0).area_m2, 1e-4);
}

}  // namespace
}  // namespace viscera
