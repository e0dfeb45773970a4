// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "solver/cpu/cpu_solver.h"

#include "solver/tissue/joined_lattice.h"
#include "support/backends.h"
#include "support/implicit.h"
#include "support/text.h"
#include "viscera/math/error.h"

using namespace viscera;
using namespace viscera::test;

namespace {

constexpr double kCpuSolverSpacing_m = 1.0 / 64;  // so positions of nodes and their differences have no rounding
constexpr int kCpuSolverSubsteps = 10;
// As for the GPU (leapfrog_gl_test.cpp): relative to the largest value, after ten substeps.
constexpr double kFloat32Displacement = 1e-6;
constexpr double kFloat32Velocity = 5e-6;
// Velocities after a single substep, that is forces, where springs have any length: two Newton steps on estimates of 12
// bits, and lengths in which 1 + q has lost up to three digits.
constexpr double kAnyLength = 1e-5;
constexpr double kOneRounding = 1.0 / (1 << 24);

/// Returns a model with every feature: dashpots, drag, fixed nodes, a part; full bricks and partial ones.
/// @param law  of one of two bodies
Model everything(Law law = Law::kSprings) {
  Body body = twoPartBody();
  body.material.mass_damping_per_s = 30;
  Body other = boxBody({13, 9, 10}, 0.01);
  other.material.law = law;
  other.lattice.origin_m = Vector3d(0.2, 0, 0);
  return modelOf({body, other});
}

/// Returns the state after pulling, probing and settling.
HostState stateAfterTools(const std::string& simd, const Model& model, int threads) {
  const PullAndProbe tools;
  const auto solver = makeCpu(simd, model, sceneFor(model, kCpuSolverSubsteps, tools.styluses, {0, 0, -9.81}), threads);
  solver->writeState(randomState(model, 1e-3, 0.5, 11));
  for (int t = 0; t < 4; ++t) solver->step(tools.motions(t, 0.04));
  return solver->readState();
}

/// Returns a box in which every spring may have any length. Its dashpots are strong enough to matter.
Body looseBox() {
  Body body = boxBody({6, 5, 7}, kCpuSolverSpacing_m);
  body.material.mass_damping_per_s = 0;
  return body;
}

/// Returns a state with everything at the position of one node, to the bit: springs of length 0.
HostState onePoint(const Model& model) {
  const Lattice& lattice = model.bodies[0].lattice;
  HostState state = restState(model);
  const Vector3d point = lattice.restPosition(lattice.active_slots[100]);
  for (uint32_t slot : lattice.active_slots) state.displacement_m[slot] = vec4(point - lattice.restPosition(slot));
  return state;
}

/// Returns a state at rest except for one corner, where springs are long, short, or of zero length: all code paths at
/// once.
HostState mildWildAndCollapsed(const Model& model) {
  const Lattice& lattice = model.bodies[0].lattice;
  HostState state = randomState(model, 0.01 * kCpuSolverSpacing_m, 0.1, 3);
  const HostState wild = randomState(model, kCpuSolverSpacing_m, 0.1, 4), point = onePoint(model);
  for (uint32_t slot : lattice.active_slots) {
    const Vector3i n = lattice.nodeAt(slot);
    if (n.x() < 3) state.displacement_m[slot] = wild.displacement_m[slot];
    if (n.x() == 2 && n.y() < 3) state.displacement_m[slot] = point.displacement_m[slot];
  }
  return state;
}

class Cpu : public ::testing::TestWithParam<std::string> {
 protected:
  std::unique_ptr<CpuSolver> make(const Model& model, const Scene& scene) const {
    return makeCpu(GetParam(), model, scene);
  }
  static void expectLikeTheBest(const Model& model) {
    const HostState best = stateAfterTools(simdTargets().front(), model, 2);
    const HostState here = stateAfterTools(GetParam(), model, 2);
    double largest_m = 0, difference_m = 0, fastest = 0, difference_m_per_s = 0;
    for (uint32_t slot : activeSlots(model)) {
      const Vector3d u = xyz(best.displacement_m[slot]), v = xyz(best.velocity_m_per_s[slot]);
      largest_m = std::max(largest_m, u.norm());
      fastest = std::max(fastest, v.norm());
      difference_m = std::max(difference_m, (xyz(here.displacement_m[slot]) - u).norm());
      difference_m_per_s = std::max(difference_m_per_s, (xyz(here.velocity_m_per_s[slot]) - v).norm());
    }
    // Four ticks in place of one, and the rounding of two states in place of one. The distance of SSE4 from AVX-512
    // depends on the processor, with the estimates of roots from which it starts.
    EXPECT_LT(difference_m, 2 * 4 * kFloat32Displacement * largest_m);
    EXPECT_LT(difference_m_per_s, 2 * 4 * kFloat32Velocity * fastest);
  }
  void expectUndisturbedByAPieceFarAway(Law law) {
    Body body = boxBody({7, 3, 3}, 0.001);
    body.material.law = law;
    for (uint32_t slot : body.lattice.active_slots) {
      if (body.lattice.nodeAt(slot).x() != 3 && body.lattice.nodeAt(slot).x() != 4) continue;
      for (uint32_t s = 0; s < layout::kSpringsPerNode; ++s) {
        const int x = body.lattice.nodeAt(slot).x(), far_x = x + kNeighborOffsets[s][0];
        if (std::min(x, far_x) == 3 && std::max(x, far_x) == 4) setSpringCount(body.lattice.nodes[slot], s, 0);
      }
      if (body.lattice.nodeAt(slot).x() == 3) body.lattice.nodes[slot].lo &= ~layout::kCellBit;
    }
    const Model model = modelOf({body});
    const auto solver = make(model, sceneFor(model, kCpuSolverSubsteps));
    HostState state = randomState(model, 5e-5, 0.1, 3);
    for (uint32_t slot : body.lattice.active_slots) {
      if (body.lattice.nodeAt(slot).x() >= 4) state.displacement_m[slot].x = 1000;  // a million spacings
    }
    solver->writeState(state);
    ReferenceSolver reference(model, Vector3d::Zero(), static_cast<float>(solver->dt_s()));
    load(reference, state);
    solver->step({});
    for (int s = 0; s < kCpuSolverSubsteps; ++s) reference.substep();
    const HostState after = solver->readState();
    double fastest = 0;
    for (uint32_t slot : body.lattice.active_slots) fastest = std::max(fastest, reference.v_m_per_s[slot].norm());
    for (uint32_t slot : body.lattice.active_slots) {
      ASSERT_TRUE(xyz(after.displacement_m[slot]).allFinite());
      if (body.lattice.nodeAt(slot).x() >= 4) continue;  // 1 km in float32: nothing is left of its strain
      EXPECT_LT((xyz(after.velocity_m_per_s[slot]) - reference.v_m_per_s[slot]).norm(), kFloat32Velocity * fastest);
    }
  }
  void expectForcesLikeReference(const Body& body, HostState (*start)(const Model&)) {
    const Model model = modelOf({body});
    const auto solver = make(model, sceneFor(model, 1));
    ReferenceSolver reference(model, Vector3d::Zero(), static_cast<float>(solver->dt_s()));
    const HostState state = start(model);
    load(reference, state);
    solver->writeState(state);
    solver->step({});
    reference.substep();
    EXPECT_LT(relativeError(solver->readState().velocity_m_per_s, reference.v_m_per_s, reference.active), kAnyLength);
  }
  void expectForcesLikeReference(HostState (*start)(const Model&)) {
    for (const double stiffness_damping_ratio : {0.0, 0.2}) {
      SCOPED_TRACE(stiffness_damping_ratio);
      Body body = looseBox();
      body.material.stiffness_damping_ratio = stiffness_damping_ratio;
      expectForcesLikeReference(body, start);
    }
  }
};

INSTANTIATE_TEST_SUITE_P(Targets, Cpu, ::testing::ValuesIn(simdTargets()), backendSuffix);

}  // namespace

TEST_P(Cpu, SameBitsForAnyNumberOfThreadsAndEveryTime) {
  for (const Law law : {Law::kSprings, Law::kNeoHookean}) {
    const Model model = everything(law);
    const uint64_t first = stateHash(model, stateAfterTools(GetParam(), model, 1));
    for (int threads : {1, 2, 3, 2}) {
      EXPECT_EQ(stateHash(model, stateAfterTools(GetParam(), model, threads)), first) << threads << " threads";
    }
  }
}

TEST_P(Cpu, AgreesWithTheBestInstructionSet) {
  for (const Law law : {Law::kSprings, Law::kNeoHookean}) expectLikeTheBest(everything(law));
}

TEST_P(Cpu, StepsAsAloneBesideASolverOfAnotherInstructionSet) {
  const Model model = everything();
  const Scene scene = sceneFor(model, 5);
  const auto hashOf = [&](const CpuSolver& solver) { return stateHash(model, solver.readState()); };
  const HostState start = randomState(model, 1e-4, 0.05, 3);
  const auto alone = [&](const std::string& target) {
    const auto solver = makeCpu(target, model, scene);
    solver->writeState(start);
    for (int t = 0; t < 3; ++t) solver->step({});
    return hashOf(*solver);
  };
  const std::string best = simdTargets().front();
  const auto here = makeCpu(GetParam(), model, scene), other = makeCpu(best, model, scene);
  here->writeState(start);
  other->writeState(start);
  for (int t = 0; t < 3; ++t) {
    here->step({});
    other->step({});
  }
  EXPECT_EQ(hashOf(*here), alone(GetParam()));
  EXPECT_EQ(hashOf(*other), alone(best));
  EXPECT_TRUE(says(here->backend(), {GetParam()}));
}

TEST_P(Cpu, SaysWhatItRunsOn) {
  const Model model = modelOf({boxBody({2, 2, 2}, 0.01)});
  EXPECT_EQ(make(model, sceneFor(model, 1))->backend(), "cpu (" + GetParam() + ", 2 threads)");
}

TEST_P(Cpu, SpringsOfOrdinaryLengthPullLikeTheReferences) {
  expectForcesLikeReference([](const Model& model) { return randomState(model, 0.02 * kCpuSolverSpacing_m, 0.1, 3); });
}

TEST_P(Cpu, SpringsOfAnyLengthPullLikeTheReferences) {
  expectForcesLikeReference([](const Model& model) { return randomState(model, kCpuSolverSpacing_m, 1, 3); });
  expectForcesLikeReference([](const Model& model) { return randomState(model, 100 * kCpuSolverSpacing_m, 1, 3); });
}

TEST_P(Cpu, SpringsOfNoLengthPushWhereTheyLieAtRest) {
  expectForcesLikeReference(onePoint);
}

TEST_P(Cpu, MildWildAndCollapsedSpringsOfOneBrickPullLikeTheReferences) {
  expectForcesLikeReference(mildWildAndCollapsed);
}

TEST_P(Cpu, PullsLikeTheReferenceWhereSomeSpringsAreCutAndOthersHalf) {
  const Model model = modelOf({blobBody(500, kCpuSolverSpacing_m, 3)});
  const auto solver = make(model, sceneFor(model, 1));
  for (const double size_m : {0.02 * kCpuSolverSpacing_m, 2 * kCpuSolverSpacing_m}) {
    ReferenceSolver reference(model, Vector3d::Zero(), static_cast<float>(solver->dt_s()));
    const HostState state = randomState(model, size_m, 0.1, 6);
    load(reference, state);
    solver->writeState(state);
    solver->step({});
    reference.substep();
    EXPECT_LT(relativeError(solver->readState().velocity_m_per_s, reference.v_m_per_s, reference.active), kAnyLength);
  }
}

/// Missing springs connect nodes at any distance: no power of it may overflow, and none may slow the rest down.
TEST_P(Cpu, PieceThatIsFarAwayDoesNotDisturbTheRest) {
  for (const Law law : {Law::kSprings, Law::kNeoHookean}) expectUndisturbedByAPieceFarAway(law);
}

TEST_P(Cpu, ForcesOfARandomStateSumToNothing) {
  for (const Law law : {Law::kSprings, Law::kNeoHookean}) {
    for (const double stiffness_damping_ratio : {0.0, 0.2}) {
      Body body = looseBox();
      body.material.law = law;
      body.material.stiffness_damping_ratio = stiffness_damping_ratio;
      const Model model = modelOf({body});
      const auto solver = make(model, sceneFor(model, 1));
      for (const auto& start : {mildWildAndCollapsed(model), randomState(model, 0.02 * kCpuSolverSpacing_m, 0.1, 5)}) {
        HostState state = start;
        for (layout::vec4& v : state.velocity_m_per_s) {
          if (stiffness_damping_ratio == 0) v = {};
        }
        solver->writeState(state);
        solver->step({});
        const HostState after = solver->readState();
        Vector3d sum = Vector3d::Zero();
        double size = 0;
        for (uint32_t slot : body.lattice.active_slots) {
          const double eighths = massEighths(state.nodes[slot]);
          sum += eighths * (xyz(after.velocity_m_per_s[slot]) - xyz(state.velocity_m_per_s[slot]));
          size += eighths * xyz(after.velocity_m_per_s[slot]).norm();
        }
        EXPECT_GT(size, 0);
        EXPECT_LT(sum.norm(), kOneRounding * size)
            << "law " << static_cast<int>(law) << ", dashpot " << stiffness_damping_ratio;
      }
    }
  }
}

/// A cube with edges of 14 nodes has bricks of whole springs inside. If one spring of a brick is missing, all of its
/// stiffnesses are read from memory, with the same result for every node without that spring.
TEST_P(Cpu, BricksOfWholeSpringsStepLikeListedSprings) {
  Body whole = boxBody({13, 13, 13}, 0.01), lacking = whole;
  const Lattice& lattice = whole.lattice;
  const uint32_t near = static_cast<uint32_t>(lattice.slotAt({5, 5, 5}));
  const uint32_t far = static_cast<uint32_t>(lattice.slotAt({6, 5, 5}));
  setSpringCount(lacking.lattice.nodes[near], 0, 0);
  setSpringCount(lacking.lattice.nodes[far], 1, 0);
  const Model models[2] = {modelOf({whole}), modelOf({lacking})};
  HostState after[2];
  for (int i = 0; i < 2; ++i) {
    const auto solver = make(models[i], sceneFor(models[0], 1));
    HostState state = randomState(models[0], 1e-3, 0.5, 9);
    state.nodes = restState(models[i]).nodes;
    solver->writeState(state);
    solver->step({});
    after[i] = solver->readState();
  }
  for (uint32_t slot : lattice.active_slots) {
    const Vector3d a = xyz(after[0].velocity_m_per_s[slot]), b = xyz(after[1].velocity_m_per_s[slot]);
    if (slot == near || slot == far) {
      EXPECT_NE(a, b);
    } else {
      ASSERT_EQ(a, b) << lattice.nodeAt(slot).transpose();
    }
  }
}

TEST(CpuSolver, InstructionSetThatIsNotThereIsRefusedWithThoseThatAre) {
  const Model model = modelOf({boxBody({2, 2, 2}, 0.01)});
  const std::string message = messageOf<SceneError>([&] { makeCpu("MMX", model, sceneFor(model, 1)); });
  EXPECT_TRUE(says(message, {"MMX", simdTargets().front()}));
}

TEST(CpuSolver, EmptyNameIsTheBestInstructionSet) {
  const Model model = modelOf({boxBody({2, 2, 2}, 0.01)});
  EXPECT_EQ(makeCpu("", model, sceneFor(model, 1), 1)->backend(), "cpu (" + simdTargets().front() + ", 1 thread)");
}
