// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "viscera/session/session.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "session/on_backends.h"
#include "support/text.h"
#include "viscera/math/error.h"

namespace viscera {
namespace {

using namespace test;

constexpr double kRestM = 1e-6;         ///< mapping positions of a few centimetres in single precision
constexpr double kFollowM = 1e-5;       ///< a held node is at the stylus; the surface is bound to its neighbours too
constexpr double kSessionForceN = 0.1;  ///< well below the force of millimetres of tissue of 20 kPa, above rounding
constexpr double kDentM = 0.003;        ///< half of the probe's depth
constexpr double kAside = 0.05;         ///< of a force on a block that is symmetric

/// On every backend, by name.
class SessionTest : public OnSceneBackend {
 protected:
  explicit SessionTest(const Scene& of = blockScene()) : session_(scene(of), context_) {}
  Session session_;
};
using SessionWithTools = SessionTest;
VISCERA_ON_EVERY_BACKEND(SessionTest);
VISCERA_ON_EVERY_BACKEND(SessionWithTools);

/// Returns the height of the vertex of the surface mesh nearest to a point at rest.
float heightAt(const SurfaceFrame& surface, const std::vector<float>& rest_m, const Vector3f& point_m) {
  size_t nearest = 0;
  float distance = std::numeric_limits<float>::max();
  for (size_t v = 0; v < rest_m.size(); v += 3) {
    const float d = (Vector3f(rest_m[v], rest_m[v + 1], rest_m[v + 2]) - point_m).norm();
    if (d < distance) distance = d, nearest = v;
  }
  return surface.positions_m.at(nearest + 2);
}

double largestMove(const SurfaceFrame& surface, const std::vector<float>& rest_m) {
  double largest = 0;
  for (size_t i = 0; i < rest_m.size(); ++i)
    largest = std::max(largest, std::abs(static_cast<double>(surface.positions_m.at(i)) - rest_m[i]));
  return largest;
}

TEST_P(SessionWithTools, ProbeDentsTheTissueAndIsPushedBackOut) {
  play(session_, press, kPressTicks + 5);
  const Frame pressed = session_.drain();
  const Vector3d force = pressed.reactions[0].force_n;
  EXPECT_GT(force.z(), kSessionForceN);
  EXPECT_LT(force.head<2>().norm(), kAside * force.z());
  EXPECT_GE(session_.extremes().peak_force_n, force.z());
  EXPECT_GT(pressed.stats.touched[0], 0u);
  EXPECT_EQ(pressed.reactions[1].force_n, Vector3d::Zero());

  const std::vector<float> rest_m = restPositions(session_);
  const SurfaceFrame surface = surfaceAfter(session_, press(kPressTicks));
  EXPECT_LT(heightAt(surface, rest_m, {0, 0, kHalfM}), kHalfM - kDentM);
  EXPECT_NEAR(heightAt(surface, rest_m, {0, 0, -kHalfM}), -kHalfM, kRestM);  // fixed
}

TEST_P(SessionWithTools, GrabbedTissueFollowsThePullAndPullsBack) {
  const auto pull = [](int tick) { return leftAt({0, 0, kHalfM + 0.0005 * tick}, true); };
  play(session_, pull, 20);
  const Frame pulled = session_.drain();
  EXPECT_GT(pulled.stats.grabbed[0], 0u);
  EXPECT_LT(pulled.reactions[0].force_n.z(), -kSessionForceN);
  const std::vector<float> rest_m = restPositions(session_);
  EXPECT_NEAR(heightAt(surfaceAfter(session_, pull(20)), rest_m, {0, 0, kHalfM}), kHalfM + 0.0095, kFollowM);
  session_.step({}, {});
  EXPECT_EQ(session_.drain().stats.grabbed[0], 0u);  // a lost stylus releases
}

TEST_P(SessionWithTools, CutSeversSpringsAndOpensTheSkin) {
  play(session_, cut, kCutTicks);
  const SurfaceFrame surface = surfaceAfter(session_, {});
  const Frame after = session_.drain();
  EXPECT_GT(after.stats.springs_cut, 0u);
  EXPECT_LT(after.stats.springs_cut, session_.model().springs());
  const size_t all = session_.wholeSkin()->triangleCount(), shown = surface.topology->triangleCount();
  EXPECT_GT(shown, all);  // lips are split, and there are walls
  EXPECT_LT(shown, 2 * all);
  EXPECT_NE(surface.topology->revision, session_.wholeSkin()->revision);
  EXPECT_EQ(after.stats.nonfinite, 0u);
}

TEST_P(SessionWithTools, ResetRestoresEverything) {
  const uint64_t at_rest = session_.stateHash();
  play(session_, cut, kCutTicks);
  play(session_, press, kPressTicks);
  const uint64_t first = session_.stateHash();
  EXPECT_NE(first, at_rest);
  session_.reset();
  EXPECT_EQ(session_.stateHash(), at_rest);
  EXPECT_EQ(session_.tick(), 0u);
  EXPECT_EQ(session_.extremes().peak_force_n, 0);
  EXPECT_FALSE(session_.drain().has_stats);

  play(session_, cut, kCutTicks);  // at once: no tool may remember its position
  play(session_, press, kPressTicks);
  EXPECT_EQ(session_.stateHash(), first);

  session_.reset();
  const SurfaceFrame surface = surfaceAfter(session_, {});
  EXPECT_LT(largestMove(surface, restPositions(session_)), kRestM);
  EXPECT_EQ(surface.topology, session_.wholeSkin());
}

TEST_P(SessionTest, TissueThatNothingActsOnStaysAtRest) {
  play(
      session_, [](int) { return StylusSamples{}; }, 10);
  const SurfaceFrame surface = surfaceAfter(session_, {});
  EXPECT_EQ(surface.tick, 11u);
  EXPECT_LT(largestMove(surface, restPositions(session_)), kRestM);
}

/// Returns a scene in which the rate of the force on the stylus is limited.
Scene slowForce() {
  Scene scene = blockScene();
  scene.styluses[0].max_force_rate_n_per_s = 2;
  return scene;
}

class SessionWithSlowForce : public SessionTest {
 protected:
  SessionWithSlowForce() : SessionTest(slowForce()) {}
};
VISCERA_ON_EVERY_BACKEND(SessionWithSlowForce);

TEST_P(SessionWithSlowForce, LostStylusHasNoForceAtOnceAllTheSame) {
  play(session_, press, kPressTicks + 5);
  ASSERT_GT(session_.drain().reactions[0].force_n.norm(), kSessionForceN);
  const Frame lost = session_.step({}, {});
  EXPECT_EQ(lost.reactions[0].force_n, Vector3d::Zero());
  EXPECT_EQ(lost.reactions[0].torque_nm, Vector3d::Zero());
}

/// Returns two adjacent blocks; the right one is pressed.
Scene twoBlocks() {
  Scene scene = blockScene();
  scene.bodies.push_back(scene.bodies[0]);
  scene.bodies[0].name = "other";
  scene.bodies[0].position_m = Vector3d(-0.1, 0, 0);
  scene.bodies[0].spacing_m = 0.01;
  return scene;
}

class SessionOfTwoBodies : public SessionTest {
 protected:
  SessionOfTwoBodies() : SessionTest(twoBlocks()) {}
};
VISCERA_ON_EVERY_BACKEND(SessionOfTwoBodies);

TEST_P(SessionOfTwoBodies, SurfaceHoldsBothAndATouchMovesOnlyOne) {
  const std::vector<float> rest_m = restPositions(session_);
  EXPECT_LT(largestMove(surfaceAfter(session_, {}), rest_m), kRestM);
  play(session_, press, kPressTicks + 5);
  const SurfaceFrame surface = surfaceAfter(session_, press(kPressTicks));
  ASSERT_EQ(surface.positions_m.size(), rest_m.size());
  EXPECT_LT(heightAt(surface, rest_m, {0, 0, kHalfM}), kHalfM - kDentM);
  EXPECT_NEAR(heightAt(surface, rest_m, {-0.1f, 0, kHalfM}), kHalfM, kRestM);
}

TEST_P(SessionTest, RunsOnTheBackendThatTheSceneAsksFor) {
  const std::string backend = session_.solver().backend();
  EXPECT_EQ(backend.rfind(GetParam() == Backend::kCpu ? "cpu (" : "gpu", 0), 0u) << backend;
  EXPECT_EQ(session_.solver().onHost(), GetParam() == Backend::kCpu);
}

/// Where a software rasteriser runs the compute shaders, the CPU backend does the same faster.
TEST_F(GpuTest, AutoTakesTheGpuWhereThereIsOneAndElseTheCpu) {
  const Session session(blockScene(), context_);
  ASSERT_EQ(blockScene().solver.backend, Backend::kAuto);
  EXPECT_EQ(session.solver().onHost(), context_.isSoftware()) << context_.renderer();
}

TEST_F(GpuTest, SceneThatNeedsMoreSubstepsThanAllowedIsRefusedWithARemedy) {
  Scene scene = blockScene();
  scene.solver.max_substeps = 3;
  const std::string message = messageOf<SceneError>([&] { Session(scene, context_); });
  EXPECT_TRUE(says(message, {"solver.max_substeps = 3", "spacing_m"}));
}

}  // namespace
}  // namespace viscera
