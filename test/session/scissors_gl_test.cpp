// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
// Scissors that close in tissue.
#include "session/on_backends.h"

namespace viscera {
namespace {

using namespace test;

class ScissorsSession : public OnSceneBackend {
 protected:
  static Scene scissorsScene() {
    Scene out = scene();
    out.bodies[0].spacing_m = 0.005;  // half of the blades' reach
    out.styluses[0].idle = ToolMode::kNone;
    out.styluses[0].button1 = ToolMode::kScissors;
    out.styluses[0].scissors.closing_s = 0.1;  // six ticks
    return out;
  }
  /// Returns scissors from above in the block, in a plane between nodes.
  static StylusSamples at(double x_m, bool closes) { return leftAt({x_m, 0.001, kHalfM - 0.008}, closes); }
};

TEST_P(ScissorsSession, CutWhatIsBetweenThemAsTheyCloseAndNothingWhileTheyAreClosedOrOpen) {
  Session session(scissorsScene(), context_);
  const auto cut = [&](int ticks, double from_m, double to_m, bool closes) {
    for (int t = 1; t <= ticks; ++t) session.step(at(from_m + (to_m - from_m) * t / ticks, closes), {});
    return session.drain().stats.springs_cut;
  };
  EXPECT_EQ(cut(10, -0.01, 0.01, false), 0U);  // open
  EXPECT_EQ(cut(10, 0.01, 0, false), 0U);
  const uint32_t once = cut(8, 0, 0, true);
  EXPECT_GT(once, 0U);
  EXPECT_EQ(cut(20, 0, 0.015, true), once);  // closed
  EXPECT_EQ(cut(5, 0.015, 0.015, false), once);
  EXPECT_GT(cut(8, 0.015, 0.015, true), once);  // again, elsewhere
}

TEST_P(ScissorsSession, CutNoFartherThanTheirMouthIsWide) {
  Scene narrow = scissorsScene(), wide = scissorsScene();
  narrow.styluses[0].scissors.opening_deg = 10;
  wide.styluses[0].scissors.opening_deg = 100;
  const auto cut = [&](const Scene& scene) {
    Session session(scene, context_);
    for (int t = 1; t <= 10; ++t) session.step(at(0, t > 1), {});
    return session.drain().stats.springs_cut;
  };
  const uint32_t few = cut(narrow), many = cut(wide);
  EXPECT_GT(few, 0U);
  EXPECT_GT(many, 2 * few);
}

TEST_P(ScissorsSession, CutAsFarAsAUserClosesThemAndNothingAsTheyOpen) {
  Scene scene = scissorsScene();
  scene.styluses[0].idle = ToolMode::kScissors;
  Session session(scene, context_);
  const auto cut = [&](double from_rad, double to_rad) {
    for (int t = 1; t <= 10; ++t) {
      StylusSamples samples = at(0, false);
      samples[0].jaw_rad = static_cast<float>(from_rad + (to_rad - from_rad) * t / 10);
      session.step(samples, {});
    }
    return session.drain().stats.springs_cut;
  };
  EXPECT_EQ(cut(0.65, 0.65), 0U);
  const uint32_t part = cut(0.65, 0.05);
  EXPECT_GT(part, 0U);
  EXPECT_EQ(cut(0.05, 0.65), part);
  EXPECT_GT(cut(0.65, 0.03), part) << "the rest of the blades";
}
VISCERA_ON_EVERY_BACKEND(ScissorsSession);

}  // namespace
}  // namespace viscera
