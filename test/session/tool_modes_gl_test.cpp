// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
// Tool modes changed during the simulation: the change acts at once, holds end, runs repeat to the bit.
#include <gtest/gtest.h>

#include "session/on_backends.h"
#include "viscera/math/error.h"

namespace viscera {
namespace {

using namespace test;

constexpr int kModeTicks = 12;

class ToolModes : public OnSceneBackend {
 protected:
  static Scene scene(bool cuts = true) {
    Scene scene = OnSceneBackend::scene();
    for (StylusConfig& stylus : scene.styluses) {
      stylus.button1 = ToolMode::kNone;
      if (!cuts) stylus.button2 = ToolMode::kNone;
    }
    return scene;
  }
  /// Returns a stylus at the top of the block, button 1 down, drawn upwards.
  static StylusSamples pull(int tick) { return leftAt({0, 0, kHalfM + 0.001 * tick}, true); }
};
VISCERA_ON_EVERY_BACKEND(ToolModes);

TEST_P(ToolModes, AModeActsFromTheNextStepAndLetsGoWhenItIsLeft) {
  for (const ToolMode mode : {ToolMode::kGrab, ToolMode::kSuction}) {
    Session session(scene(), context_);
    play(session, pull, 2);
    EXPECT_EQ(session.drain().stats.grabbed[0], 0u);
    session.setToolMode(0, ToolSwitch::kButton1, mode);
    play(session, pull, 2);
    EXPECT_GT(session.drain().stats.grabbed[0], 0u);
    session.setToolMode(0, ToolSwitch::kButton1, ToolMode::kNone);
    play(session, pull, 1);
    EXPECT_EQ(session.drain().stats.grabbed[0], 0u);
  }
}

TEST_P(ToolModes, CutsOnlyWhereTheSceneWasMadeForThem) {
  {
    Session session(scene(), context_);
    session.setToolMode(0, ToolSwitch::kButton2, ToolMode::kNone);
    play(session, cut, kCutTicks);
    EXPECT_EQ(session.drain().stats.springs_cut, 0u);
    session.resetInput();
    session.setToolMode(0, ToolSwitch::kButton2, ToolMode::kCutParticles);
    play(session, cut, kCutTicks);
    EXPECT_GT(session.drain().stats.springs_cut, 0u);
  }
  Session uncut(scene(false), context_);
  for (const ToolMode mode : {ToolMode::kCut, ToolMode::kCutParticles})
    EXPECT_THROW(uncut.setToolMode(0, ToolSwitch::kButton2, mode), SceneError);
  uncut.setToolMode(0, ToolSwitch::kButton2, ToolMode::kSuction);
}

TEST_P(ToolModes, TheSameChangesAtTheSameTicksGiveTheSameState) {
  const auto hash = [this](int at) {
    Session session(scene(), context_);
    for (int t = 1; t <= kModeTicks; ++t) {
      if (t == at) session.setToolMode(0, ToolSwitch::kButton1, ToolMode::kGrab);
      session.step(pull(t), {});
    }
    return session.stateHash();
  };
  EXPECT_EQ(hash(3), hash(3));
  EXPECT_NE(hash(3), hash(kModeTicks + 1));
}

}  // namespace
}  // namespace viscera
