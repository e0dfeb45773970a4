// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
// A stylus that appears inside tissue neither pushes nor is pushed until it was outside (physics.md 5).
#include <gtest/gtest.h>

#include "session/on_backends.h"

namespace viscera {
namespace {

using namespace test;

constexpr double kForceN = 0.1;  ///< well below the force of millimetres of tissue of 20 kPa, well above rounding
constexpr int kGapTicks = 60;    ///< tissue comes back meanwhile
constexpr int kHeldTicks = 8;

class Appearing : public OnSceneBackend {
 protected:
  Appearing() : session_(scene(), context_) {}

  static StylusSamples deep(int) { return press(kPressTicks); }
  static StylusSamples absent(int) { return {}; }
  static StylusSamples withdrawn(int) { return leftAt({0, 0, 3 * kHalfM}); }

  /// Expects no force and no moved node, and that the frame gives the reason.
  void expectNothingHappens() {
    const uint64_t before = session_.stateHash();
    for (int t = 0; t < kHeldTicks; ++t) {
      const Frame frame = session_.step(deep(t), {});
      EXPECT_TRUE(frame.inside[0]);
      EXPECT_FALSE(frame.inside[1]);
      EXPECT_EQ(frame.reactions[0].force_n, Vector3d::Zero());
      EXPECT_GT(frame.stats.touched[0], 0u);
    }
    EXPECT_EQ(session_.drain().reactions[0].force_n, Vector3d::Zero());
    EXPECT_EQ(session_.stateHash() == before, at_rest_);
  }
  void expectForceOutwards() {
    play(session_, press, kPressTicks + 5);
    EXPECT_GT(session_.drain().reactions[0].force_n.z(), kForceN);
    EXPECT_FALSE(session_.step(deep(0), {}).inside[0]);
  }

  Session session_;
  bool at_rest_ = true;  ///< the tissue is at rest, and must stay so
};
VISCERA_ON_EVERY_BACKEND(Appearing);

class AppearingAbove : public OnSceneBackend {};
VISCERA_ON_EVERY_BACKEND(AppearingAbove);

TEST_P(Appearing, AtDepthDoesNothingUntilItWasOutside) {
  expectNothingHappens();
  play(session_, withdrawn, 1);
  expectForceOutwards();
}

TEST_P(Appearing, AfterAGapAtDepthDoesNothingUntilItWasOutside) {
  expectForceOutwards();
  play(session_, absent, kGapTicks);
  at_rest_ = false;  // it still oscillates
  expectNothingHappens();
  play(session_, withdrawn, 2);
  expectForceOutwards();
}

/// Where cells are partially filled, nodes are above the surface: a tip in the air next to them is outside.
TEST_P(AppearingAbove, InTheAirWithinACellOfTheSkinPushesAtOnce) {
  Scene low = scene();
  BodyConfig& body = low.bodies[0];
  body.spacing_m = 0.005;                       // the probe is no finer
  body.box_size_m.z() -= 0.9 * body.spacing_m;  // the lowest cells and the highest are filled to 0.55
  body.fixed[0].point_m.z() = -0.5 * body.box_size_m.z();
  Session session(low, context_);
  const double skin_m = 0.5 * body.box_size_m.z(), begin_m = skin_m + low.styluses[0].probe.radius_m + 0.0005;
  for (int t = 0; t < 6; ++t) EXPECT_FALSE(session.step(leftAt({0, 0, begin_m - 0.0007 * t}), {}).inside[0]) << t;
  EXPECT_GT(session.drain().reactions[0].force_n.z(), kForceN);
}

TEST_P(Appearing, ClearedToolsLetGoAndAppearAgain) {
  const auto pull = [](int tick) { return leftAt({0, 0, kHalfM + 0.0005 * tick}, true); };
  ASSERT_GT(play(session_, pull, kHeldTicks).stats.grabbed[0], 0u);
  session_.resetInput();
  session_.step(withdrawn(0), {});
  EXPECT_EQ(session_.drain().stats.grabbed[0], 0u);
  expectForceOutwards();
  session_.resetInput();
  at_rest_ = false;
  expectNothingHappens();
}

}  // namespace
}  // namespace viscera
