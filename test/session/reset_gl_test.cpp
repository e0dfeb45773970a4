// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// After reset() a session behaves as a new one, whatever was done to it: state, measurements, forces and surface meshes
// are the same to the bit.
#include <gtest/gtest.h>

#include <cstring>
#include <limits>
#include <memory>

#include "session/block_session.h"
#include "support/gpu_fixture.h"

namespace viscera {
namespace {

using namespace test;

constexpr int kAfterTicks =
    7;  ///< after the reset: the first ones show any remaining state, and the probe touches by the fourth

/// What is done to a session, and what must have happened by then for the test to be meaningful.
struct Disturbance {
  std::string name;
  std::function<Scene()> scene = blockScene;
  StrokesByTick strokes = press;
  int ticks = 25;
  std::function<bool(const Frame& last, const Session& session)> happened = [](const Frame& last, const Session&) {
    return last.stats.touched[0] > 0;
  };
  std::function<void(Session&, int tick)> before = [](Session&, int) {};  ///< each tick
};

bool wasCut(const Frame& last, const Session&) {
  return last.stats.springs_cut > 0;
}
bool moves(const Frame& last, const Session&) {
  return last.stats.kinetic_j > 0;
}
bool holds(const Frame& last, const Session&) {
  return last.stats.grabbed[0] > 0;
}
bool tripped(const Frame&, const Session& session) {
  return session.extremes().roll_backs > 0;
}

constexpr int kPauseTicks = 3;

/// Returns a stroke that cuts, then pushes one side of the wound into the other.
StylusSamples cutAndClose(int tick) {
  if (tick <= kCutTicks) return cut(tick);
  if (tick < kCutTicks + kPauseTicks) return {};  // or the stylus would be speed-limited on its way over
  const double share = std::min(1.0, (tick - kCutTicks - kPauseTicks) / 12.0);
  return leftAt({0, 0.034 - 0.02 * share, 0.01});
}

/// Returns a stroke that takes hold of the top and swings it about; it still holds it at the end.
StylusSamples swing(int tick) {
  return leftAt({0.004 * std::sin(0.7 * tick), 0.002 * tick / 10.0, kHalfM + 0.0004 * tick}, true);
}

/// Returns the same, with a non-finite pose for a tick.
StylusSamples swingToNoPlace(int tick) {
  StylusSamples samples = swing(tick);
  if (tick == 12) samples[0].pose.position_m.x() = std::numeric_limits<double>::quiet_NaN();
  return samples;
}

StylusSamples cutAndTrip(int tick) {
  if (tick < kCutTicks + kPauseTicks) return cutAndClose(tick);
  return swingToNoPlace(tick - kCutTicks - kPauseTicks);
}

/// Returns a stroke that holds with one stylus, presses and cuts with the other.
StylusSamples bothTools(int tick) {
  StylusSamples samples = swing(tick);
  samples[1] = cutAndClose(tick)[0];
  return samples;
}

StylusSamples noTools(int /*tick*/) {
  return {};
}

/// Returns a coarse block, as the search for contacts is slow in software.
Scene coarseBlock() {
  Scene scene = blockScene();
  scene.bodies[0].spacing_m = 0.01;
  return scene;
}

Scene withCollisions(Scene scene) {
  scene.collision.enabled = true;
  return scene;
}

/// Returns two blocks that a force drives into each other.
Scene meetingBlocks() {
  Scene scene = withCollisions(coarseBlock());
  scene.bodies.push_back(scene.bodies[0]);
  scene.bodies[1].name = "other";
  scene.bodies[1].fixed.clear();
  scene.bodies[1].position_m = Vector3d(0.0505, 0.002, 0.001);
  scene.bodies[1].force_n = Vector3d(-2, 0, 0);
  return scene;
}

Scene withPlough() {
  Scene scene = blockScene();
  ObstacleConfig plough;
  plough.shape = ObstacleShape::kCapsule;
  plough.radius_m = 0.01;
  plough.length_m = 0.05;
  plough.position_m = Vector3d(-0.032, 0, 0.015);
  plough.velocity_m_per_s = Vector3d(0.06, 0, 0);
  plough.rotation_deg = Vector3d(90, 0, 0);
  plough.rotation_deg_per_s = Vector3d(0, 0, 40);
  scene.obstacles = {plough};
  return scene;
}

/// Returns a cloth in gusts, fixed at two corners, over a block.
Scene clothScene(Structure structure = Structure::kSurface) {
  Scene scene = withCollisions(coarseBlock());
  scene.solver.tick_hz = 240;  // light cloth has short substeps
  BodyConfig cloth;
  cloth.name = "cloth";
  cloth.source = TissueSource::kSheet;
  cloth.structure = structure;
  cloth.box_size_m = Vector3d(0.08, 0.08, 0.001);
  cloth.spacing_m = 0.01;
  cloth.bending_ratio = 0.05;
  cloth.position_m = Vector3d(0, 0, kHalfM + 0.003);
  cloth.material.density_kg_per_m3 = 600;
  FixedConfig corner;
  corner.shape = FixedShape::kSphere;
  corner.center_m = Vector3d(-0.04, -0.04, 0);
  cloth.fixed = {corner};
  scene.bodies.push_back(cloth);
  scene.environment.gravity_m_per_s2 = Vector3d(0, 0, -9.81);
  scene.environment.wind.velocity_m_per_s = Vector3d(3, 1, 0.5);
  scene.environment.wind.gust_ratio = 0.8;
  return scene;
}

/// Returns a block; with leapfrog, of nearly incompressible tissue.
Scene blockOf(Integrator integrator) {
  Scene scene = blockScene();
  if (integrator == Integrator::kLeapfrog) scene.bodies[0].material.poisson_ratio = 0.4;
  scene.solver.integrator = integrator;
  scene.solver.iterations = 5;
  return scene;
}

Scene blockOfSprings() {
  Scene scene = blockScene();
  scene.bodies[0].material.law = Law::kSprings;
  return scene;
}

Scene explicitBlock() {
  Scene scene = blockScene();
  scene.bodies[0].structure = Structure::kExplicit;
  return scene;
}

std::vector<Disturbance> toolDisturbances() {
  const auto suction = [] {
    Scene scene = blockScene();
    scene.styluses[0].button1 = ToolMode::kSuction;
    return scene;
  };
  const auto particles = [] {
    Scene scene = blockOf(Integrator::kLeapfrog);
    scene.styluses[0].button2 = ToolMode::kCutParticles;
    return scene;
  };
  const auto compensated = [] {
    Scene scene = blockScene();
    scene.solver.compensated = true;
    return scene;
  };
  return {
      {"probe"},
      {"cut", blockScene, cut, kCutTicks, wasCut},
      {"cut_particles", particles, cut, kCutTicks, wasCut},
      {"grab", blockScene, swing, 25, holds},
      {"suction", suction,
       [](int t) {
         return leftAt({0, 0, kHalfM - 0.0001 * t}, true);
       },
       25, holds},
      {"both_hands", blockScene, bothTools, 30, holds},
      {"trip", blockScene, swingToNoPlace, 14, tripped},
      {"trip_and_recovery", blockScene, swingToNoPlace, 40, tripped},
      {"compensated", compensated, cutAndClose, 30, wasCut},
  };
}

std::vector<Disturbance> integratorDisturbances() {
  const auto under = [](Integrator integrator) { return [integrator] { return blockOf(integrator); }; };
  const auto meeting = [](Integrator integrator) {
    return [integrator] {
      Scene scene = meetingBlocks();
      scene.solver.integrator = integrator;
      scene.solver.iterations = 5;
      return scene;
    };
  };
  return {
      {"leapfrog_nearly_incompressible", under(Integrator::kLeapfrog), cutAndClose, 30, wasCut},
      {"leapfrog_springs", blockOfSprings, cutAndClose, 30, wasCut},
      {"pd", under(Integrator::kPd), bothTools, 30, holds},
      {"verlet_paper", under(Integrator::kVerletPaper), bothTools, 30, holds},
      {"pd_trip", under(Integrator::kPd), swingToNoPlace, 14, tripped},
      {"verlet_paper_trip", under(Integrator::kVerletPaper), swingToNoPlace, 14, tripped},
      {"pd_contacts", meeting(Integrator::kPd), cutAndClose, 30, wasCut},
  };
}

std::vector<Disturbance> surroundingDisturbances() {
  const auto wound = [] { return withCollisions(blockScene()); };
  const auto carried = [] {
    Scene scene = withPlough();
    scene.obstacles[0].frame = "arm";
    scene.obstacles[0].velocity_m_per_s = Vector3d::Zero();
    return scene;
  };
  const auto carry = [](Session& session, int tick) {
    session.setObstacleFrame(0, {Vector3d(0.001 * tick, 0, 0), Quaterniond::Identity()});
  };
  return {
      {"wound_that_touches", wound, cutAndClose, 30, wasCut},
      {"wound_and_trip", wound, cutAndTrip, 30, tripped},
      {"bodies_that_meet", meetingBlocks, noTools, 25, moves},
      {"bodies_that_meet_and_are_cut", meetingBlocks, cutAndClose, 30, wasCut},
      {"obstacle", withPlough, noTools, 25, moves},
      {"obstacle_and_cut", withPlough, cut, 25, wasCut},
      {"carried_obstacle", carried, noTools, 25, moves, carry},
      {"cloth_in_wind", [] { return clothScene(); }, noTools, 25, moves},
      {"cloth_is_cut", [] { return clothScene(); }, cutAndClose, 30, wasCut},
  };
}

std::vector<Disturbance> networkDisturbances() {
  const auto clothUnder = [](Integrator integrator) {
    return [integrator] {
      Scene scene = clothScene();
      scene.solver.integrator = integrator;
      scene.solver.iterations = 5;
      return scene;
    };
  };
  return {
      {"explicit", explicitBlock, bothTools, 30, holds},
      {"explicit_is_cut", explicitBlock, cutAndClose, 30, wasCut},
      {"explicit_trip", explicitBlock, swingToNoPlace, 14, tripped},
      {"cloth_is_held", [] { return clothScene(); }, bothTools, 30, wasCut},
      {"cloth_pd", clothUnder(Integrator::kPd), bothTools, 30, wasCut},
  };
}

std::vector<Disturbance> allDisturbances() {
  std::vector<Disturbance> out;
  for (auto some : {toolDisturbances, integratorDisturbances, surroundingDisturbances, networkDisturbances}) {
    for (Disturbance& it : some()) out.push_back(std::move(it));
  }
  return out;
}

/// Everything by which two sessions can be distinguished.
struct Trace {
  std::vector<uint64_t> hashes;  ///< [ticks]
  std::vector<layout::TickStats> stats;
  std::vector<Vector3d> forces_n;
  SurfaceFrame surface;
};

StylusSamples afterwards(int tick) {
  return press(tick);
}

Trace traceOf(Session& session, const Disturbance& it) {
  Trace out;
  for (int t = 1; t <= kAfterTicks; ++t) {
    it.before(session, kAfterTicks);  // frames stay where they are at a reset
    session.step(afterwards(t), {});
    const Frame frame = session.drain();
    out.hashes.push_back(session.stateHash());
    out.stats.push_back(frame.stats);
    out.forces_n.push_back(frame.reactions[0].force_n);
  }
  out.surface = surfaceAfter(session, {});
  return out;
}

std::vector<uint32_t> wordsOf(const layout::TickStats& stats) {
  std::vector<uint32_t> out(sizeof stats / sizeof(uint32_t));
  std::memcpy(out.data(), &stats, sizeof stats);
  return out;
}

void expectSame(const Trace& a, const Trace& b) {
  for (size_t t = 0; t < a.hashes.size(); ++t) {
    ASSERT_EQ(a.hashes[t], b.hashes[t]) << "tick " << t + 1;
    EXPECT_EQ(wordsOf(a.stats[t]), wordsOf(b.stats[t])) << "measurements of tick " << t + 1;
    EXPECT_EQ(a.forces_n[t], b.forces_n[t]) << "tick " << t + 1;
  }
  EXPECT_EQ(a.surface.positions_m, b.surface.positions_m);
  EXPECT_EQ(a.surface.normals, b.surface.normals);
  EXPECT_EQ(a.surface.topology->triangleCount(), b.surface.topology->triangleCount());
}

class ResetAfter : public ::testing::TestWithParam<std::tuple<Disturbance, Backend>> {
 protected:
  ResetAfter() : context_(std::make_unique<gpu::Context>()) { gpu::checkDispatches(true); }
  std::unique_ptr<Session> make() const {
    Scene scene = std::get<0>(GetParam()).scene();
    scene.solver.backend = std::get<1>(GetParam());
    return std::make_unique<Session>(scene, *context_);
  }

 private:
  std::unique_ptr<gpu::Context> context_;
};

std::string disturbanceName(const ::testing::TestParamInfo<std::tuple<Disturbance, Backend>>& info) {
  return std::get<0>(info.param).name + (std::get<1>(info.param) == Backend::kCpu ? "_cpu" : "_gpu");
}

INSTANTIATE_TEST_SUITE_P(Everything, ResetAfter,
                         ::testing::Combine(::testing::ValuesIn(allDisturbances()),
                                            ::testing::Values(Backend::kGpu, Backend::kCpu)),
                         disturbanceName);

TEST_P(ResetAfter, GoesOnAsANewSession) {
  const Disturbance& it = std::get<0>(GetParam());
  const auto session = make();
  it.before(*session, kAfterTicks);
  const Trace fresh = traceOf(*session, it);
  session->step({}, {});  // the stylus is absent, or it would come back within tissue
  session->reset();
  Frame last;
  for (int t = 1; t <= it.ticks; ++t) {
    it.before(*session, t);
    session->step(it.strokes(t), {});
    last = session->drain();
  }
  ASSERT_TRUE(it.happened(last, *session)) << "nothing was disturbed";
  it.before(*session, kAfterTicks);
  session->reset();
  expectSame(fresh, traceOf(*session, it));
}

}  // namespace
}  // namespace viscera
