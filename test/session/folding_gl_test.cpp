// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
// Tissue that a tool penetrates deeply pushes back, and returns by itself (physics.md 3).
#include <gtest/gtest.h>

#include "session/on_backends.h"
#include "solver/tissue/fields.h"

namespace viscera {
namespace {

using namespace test;

class Folding : public OnSceneBackend {
 protected:
  /// Pushes a ball with a radius of two cells through most of the block and out at its side.
  static void pushThrough(Session& session) {
    constexpr int kDown = 20, kAside = 60;
    for (int t = 0; t <= kDown; ++t) session.step(leftAt({0, 0, kHalfM + kBall_m - 1.6 * kHalfM * t / kDown}), {});
    for (int t = 0; t <= kAside; ++t) session.step(leftAt({4 * kHalfM * t / kAside, 0, kBall_m - 0.6 * kHalfM}), {});
    for (int t = 0; t < kGapTicks; ++t) session.step({}, {});
    session.drain();
  }
  static Scene pressed(Scene scene) {
    scene.bodies[0].spacing_m = 0.5 * kBall_m;
    scene.styluses[0].probe.radius_m = kBall_m;
    scene.environment.gravity_m_per_s2 = Vector3d::Zero();
    return scene;
  }
  static double strayed(const Session& session) {
    double out = 0;
    for (const layout::vec4& u : session.solver().readState().displacement_m) out = std::max(out, xyz(u).norm());
    return out / session.scene().bodies[0].spacing_m;
  }

  static constexpr double kBall_m = 0.5 * kHalfM;
  static constexpr int kGapTicks = 100;
  static constexpr double kBack = 0.1;  ///< [spacings] as in `viscera bench stability`
};
VISCERA_ON_EVERY_BACKEND(Folding);

TEST_P(Folding, ComesBackOnceTheToolIsAway) {
  Session session(pressed(scene()), context_);
  pushThrough(session);
  EXPECT_LT(strayed(session), kBack);
}

/// Cells are not inverted while a ball presses, even deep inside.
TEST_P(Folding, PushesBackHarderTheDeeperABallIs) {
  constexpr int kPresses = 12, kHolds = 10;
  constexpr double kDeepest = 0.8;  // of half the block
  constexpr double kHarder = 1.2;   // least ratio; Hertz' force at 2, 3 and 4 times the depth gives 2.8, 1.8 and 1.5
  Scene deep = pressed(scene());
  deep.styluses[0].max_force_n = 50;  // more than the actual force
  Session session(deep, context_);
  const auto at = [&](double share) { return leftAt({0, 0, kHalfM + kBall_m - share * kDeepest * kHalfM}); };
  session.step(at(-0.1), {});  // a ball that appears in tissue pushes nothing
  double before_n = 0;
  for (int k = 1; k <= 4; ++k) {
    for (int t = 1; t <= kPresses; ++t) session.step(at(0.25 * (k - 1 + static_cast<double>(t) / kPresses)), {});
    Frame held;
    for (int t = 0; t < kHolds; ++t) held = session.step(at(0.25 * k), {});
    const double now_n = held.reactions[0].force_n.norm();
    EXPECT_GT(now_n, kHarder * before_n) << k;
    before_n = now_n;
  }
  pushThrough(session);
  EXPECT_LT(strayed(session), kBack);
}

}  // namespace
}  // namespace viscera
