// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
// A session resumed from a saved one ends as the one that was never stopped: to the bit, whatever was going on.
#include <gtest/gtest.h>

#include <random>
#include <tuple>

#include "session/block_session.h"
#include "session/state_file.h"
#include "support/gpu_fixture.h"
#include "support/temporary_folder.h"
#include "viscera/math/error.h"

namespace viscera {
namespace {

using namespace test;

struct Steps {
  const char* name;
  Integrator integrator;
};
void PrintTo(const Steps& steps, std::ostream* out) {
  *out << steps.name;
}

class Saved : public GpuTest, public ::testing::WithParamInterface<std::tuple<Steps, Backend>> {
 protected:
  static Scene scene() {
    Scene scene = blockScene();
    scene.environment.gravity_m_per_s2 = Vector3d(0, 0, -9.81);
    scene.solver.integrator = std::get<0>(GetParam()).integrator;
    scene.solver.iterations = 4;  // of pd: the saved data do not depend on their number
    scene.solver.backend = std::get<1>(GetParam());
    scene.styluses[1].button1 = ToolMode::kGrab;
    return scene;
  }
  /// Makes a session. Those on the GPU share their context; those on the CPU need none, and their views would keep it.
  Session made(const Scene& scene) {
    if (scene.solver.backend == Backend::kCpu) return Session(scene);
    return {scene, context_};
  }
  /// Saves after one tick and continues; another session resumes there. Both must end in the same state.
  void expectSameEnd(const Scene& scene, const StrokesByTick& strokes, int saved_after, int ticks) {
    const std::string file = folder_.file("state");
    Session unbroken = made(scene);
    for (int t = 1; t <= ticks; ++t) unbroken.step(strokes(t), {});
    const uint64_t end_hash = unbroken.stateHash();
    Session stopped = made(scene);
    for (int t = 1; t <= saved_after; ++t) stopped.step(strokes(t), {});
    stopped.save(file);
    const uint64_t saved_hash = stopped.stateHash();
    Session& resumed = unbroken;  // restoring does not depend on the previous state
    resumed.restore(file);
    EXPECT_EQ(resumed.tick(), static_cast<uint64_t>(saved_after));
    EXPECT_EQ(resumed.stateHash(), saved_hash);
    for (int t = saved_after + 1; t <= ticks; ++t) {
      stopped.step(strokes(t), {});
      resumed.step(strokes(t), {});
    }
    const Frame a = stopped.drain(), b = resumed.drain();
    EXPECT_EQ(resumed.stateHash(), end_hash) << "saved after tick " << saved_after;
    EXPECT_EQ(stopped.stateHash(), end_hash) << "saving changed something after tick " << saved_after;
    EXPECT_EQ(a.stats.springs_cut, b.stats.springs_cut);
    EXPECT_EQ(a.reactions[0].force_n, b.reactions[0].force_n);
    EXPECT_EQ(stopped.counters().substeps, resumed.counters().substeps);
    EXPECT_EQ(stopped.extremes().peak_force_n, resumed.extremes().peak_force_n);
  }
  TemporaryFolder folder_;
};

INSTANTIATE_TEST_SUITE_P(All, Saved,
                         ::testing::Combine(::testing::Values(Steps{"leapfrog", Integrator::kLeapfrog},
                                                              Steps{"pd", Integrator::kPd},
                                                              Steps{"verlet_paper", Integrator::kVerletPaper}),
                                            ::testing::Values(Backend::kCpu, Backend::kGpu)),
                         [](const auto& info) {
                           return std::string(std::get<0>(info.param).name) +
                                  (std::get<1>(info.param) == Backend::kCpu ? "_cpu" : "_gpu");
                         });

/// Returns a stroke that cuts, and pulls the cut edge with the other stylus; both continue throughout.
StylusSamples cutAndPull(int tick) {
  StylusSamples samples = tick <= kCutTicks ? cut(tick) : press(tick - kCutTicks);
  if (tick > 2) samples[1] = {true, {{0.012, 0.006, kHalfM + 0.0004 * (tick - 2)}, Quaterniond::Identity()}, true};
  return samples;
}

TEST_P(Saved, GoesOnToTheSameEndInTheMiddleOfACut) {
  expectSameEnd(scene(), cutAndPull, kCutTicks / 2, 3 * kCutTicks);
}

TEST_P(Saved, GoesOnToTheSameEndWhileCutTissueIsPushedAndPulled) {
  expectSameEnd(scene(), cutAndPull, kCutTicks + 5, 3 * kCutTicks);
}

TEST_P(Saved, GoesOnToTheSameEndAmongMovingThings) {
  if (std::get<0>(GetParam()).integrator == Integrator::kVerletPaper) GTEST_SKIP() << "knows no environment";
  Scene scene = Saved::scene();
  ObstacleConfig ball;
  ball.name = "ball";
  ball.shape = ObstacleShape::kSphere;
  ball.radius_m = 0.01;
  ball.position_m = Vector3d(0, 0, kHalfM + 0.012);
  ball.velocity_m_per_s = Vector3d(0, 0, -0.05);
  scene.obstacles = {ball};
  scene.environment.wind.velocity_m_per_s = Vector3d(3, 0, 0);
  scene.environment.wind.gust_ratio = 0.5;
  scene.collision.enabled = true;
  expectSameEnd(scene, cutAndPull, kCutTicks + 3, 2 * kCutTicks);
}

/// Sleeping bricks, of tissue that nothing touches any more.
TEST_P(Saved, GoesOnToTheSameEndWhenTissueFallsAsleep) {
  Scene scene = Saved::scene();
  scene.bodies[0].material.stiffness_damping_ratio = 0.5;
  const StrokesByTick once = [](int tick) {
    return tick < 8 ? press(tick) : tick > 55 ? press(tick - 50) : StylusSamples{};
  };
  for (const int after : {20, 50}) expectSameEnd(scene, once, after, 62);
}

/// Files with a right checksum although their bytes are wrong: whatever they contain, the session continues.
TEST_P(Saved, SpoiltBytesWithRightSumsAreRefusedOrGoOn) {
  constexpr int kMostSpoilt = 200;
  const auto& [steps, backend] = GetParam();
  const int files = steps.integrator == Integrator::kLeapfrog && backend == Backend::kCpu ? 100 : 10;
  const std::string file = folder_.file("state"), spoilt = folder_.file("spoilt");
  Session session = made(scene());
  for (int t = 1; t <= kCutTicks; ++t) session.step(cutAndPull(t), {});
  session.save(file);
  const std::vector<Archive::Section> sections = readStateFile(file);
  std::mt19937 random(1);
  int refused = 0;
  for (int time = 0; time < files; ++time) {
    std::vector<Archive::Section> made = sections;
    for (unsigned n = 1 + random() % kMostSpoilt; n > 0; --n) {
      std::vector<char>& bytes = made[1 + random() % (made.size() - 1)].bytes;  // all but that of the scene
      if (!bytes.empty()) bytes[random() % bytes.size()] = static_cast<char>(random());
    }
    writeStateFile(spoilt, made);
    try {
      session.restore(spoilt);
    } catch (const Error& error) {
      EXPECT_NE(std::string(error.what()).find(spoilt), std::string::npos) << error.what();
      ++refused;
    }
    for (int t = 1; t <= 3; ++t) session.step(cutAndPull(t), {});
  }
  EXPECT_GT(refused, 0);
  session.restore(file);
  EXPECT_EQ(session.tick(), static_cast<uint64_t>(kCutTicks));
}

TEST_P(Saved, IsRefusedByAnotherSceneAndByOtherTissue) {
  const std::string file = folder_.file("state");
  Session session = made(scene());
  play(session, press, 3);
  session.save(file);
  const auto refused = [&](const Scene& other, const std::string& why) {
    Session here = made(other);
    try {
      here.restore(file);
      ADD_FAILURE() << "taken: " << why;
    } catch (const Error& error) {
      EXPECT_NE(std::string(error.what()).find(why), std::string::npos) << error.what();
      EXPECT_NE(std::string(error.what()).find(file), std::string::npos) << error.what();
    }
    play(here, press, 2);
  };
  Scene softer = scene();
  softer.bodies[0].material.young_modulus_pa *= 0.5;
  refused(softer, "young_modulus_pa");
  Scene finer = scene();
  finer.bodies[0].spacing_m *= 0.8;
  refused(finer, "spacing_m");
  Scene more = scene();
  more.bodies.push_back(more.bodies[0]);
  refused(more, "another scene");
  Scene seen = scene();
  seen.cameras.clear();
  seen.solver.threads = 1;
  Session here = made(seen);
  here.restore(file);
  EXPECT_EQ(here.stateHash(), session.stateHash());
}

}  // namespace
}  // namespace viscera
