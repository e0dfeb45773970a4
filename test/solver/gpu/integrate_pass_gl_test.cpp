// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "viscera/solver/gpu/integrate_pass.h"

#include "support/gpu_fixture.h"
#include "viscera/math/error.h"

using namespace viscera;
using namespace viscera::test;

namespace {

// Relative to the largest value: float32 rounds at 6e-8 and some twenty roundings per substep add up over ten substeps.
constexpr double kFloat32Displacement = 1e-6;
constexpr double kFloat32Velocity = 5e-6;
constexpr int kSubsteps = 10;

HostState randomState(const Model& model, double size_m, double speed_m_per_s, uint32_t seed) {
  std::mt19937 random(seed);
  HostState state = restState(model);
  for (uint32_t slot : model.bodies[0].lattice.active_slots) {
    state.displacement_m[slot] = vec4(randomVector(random, size_m));
    state.velocity_m_per_s[slot] = vec4(randomVector(random, speed_m_per_s));
  }
  return state;
}

class Integrate : public GpuTest {
 protected:
  void expectLikeReference(const Model& model, const Vector3d& gravity) {
    const Scene scene = sceneFor(model, kSubsteps, {}, gravity);
    GpuSolver solver(model, scene);
    const HostState start = randomState(model, 0.05 * model.bodies[0].lattice.spacing_m, 0.1, 7);
    solver.writeState(start);
    ReferenceSolver reference(model, gravity, static_cast<float>(solver.dt_s()));
    load(reference, start);
    solver.step({});
    for (int s = 0; s < solver.substeps(); ++s) reference.substep();
    const HostState end = solver.readState();
    EXPECT_LT(relativeError(end.displacement_m, reference.u_m, reference.active), kFloat32Displacement);
    EXPECT_LT(relativeError(end.velocity_m_per_s, reference.v_m_per_s, reference.active), kFloat32Velocity);
  }
};

}  // namespace

TEST_F(Integrate, MatchesReferenceAtEverySize) {
  for (size_t size : kSizes) {
    SCOPED_TRACE(size);
    Body body = blobBody(size, 0.01, 3);
    body.material.dashpot_ratio = 0;
    expectLikeReference(modelOf({body}), Vector3d(0.3, -0.2, -9.81));
  }
}

TEST_F(Integrate, MatchesReferenceWithDashpotAndDrag) {
  for (size_t size : kSizes) {
    SCOPED_TRACE(size);
    Body body = blobBody(size, 0.01, 4);
    body.material.dashpot_ratio = 0.2;
    body.material.drag_per_s = 50;
    expectLikeReference(modelOf({body}), Vector3d::Zero());
  }
}

TEST_F(Integrate, BodiesDoNotFeelEachOther) {
  Body soft = boxBody({3, 3, 3}, 0.01), stiff = boxBody({5, 2, 4}, 0.02);
  stiff.material.young_modulus_pa = 5 * soft.material.young_modulus_pa;
  expectLikeReference(modelOf({soft, stiff}), Vector3d(0, 0, -9.81));
}

TEST_F(Integrate, FixedNodesStay) {
  Body body = boxBody({4, 4, 4}, 0.01);
  for (uint32_t slot : body.lattice.active_slots) {
    if (body.lattice.nodeAt(slot).z() == 4) body.lattice.nodes[slot].lo |= layout::kFixedBit;
  }
  const Model model = modelOf({body});
  GpuSolver solver(model, sceneFor(model, 50, {}, Vector3d(0, 0, -9.81)));
  for (int t = 0; t < 20; ++t) solver.step({});
  const HostState state = solver.readState();
  for (uint32_t slot : body.lattice.active_slots) {
    const Vector3d u = xyz(state.displacement_m[slot]);
    if (isFixed(body.lattice.nodes[slot])) {
      EXPECT_EQ(u, Vector3d::Zero().eval());
    } else {
      EXPECT_LT(u.z(), 0);
    }
  }
}

TEST_F(Integrate, StateHashDoesNotDependOnGroupSize) {
  const Model model = modelOf({boxBody({9, 7, 8}, 0.01)});
  uint64_t first = 0;
  for (uint32_t group_size : {32u, 64u, 128u, 256u}) {
    GpuSolver solver(model, sceneFor(model, 20, {}, Vector3d(0, 0, -9.81)), group_size);
    HostState start = randomState(model, 1e-3, 0.5, 11);
    solver.writeState(start);
    for (int t = 0; t < 5; ++t) solver.step({});
    const uint64_t hash = stateHash(model, solver.readState());
    if (first == 0) first = hash;
    EXPECT_EQ(hash, first) << "group size " << group_size;
  }
}

TEST_F(Integrate, ResetRestoresTheHash) {
  const Model model = modelOf({boxBody({4, 5, 6}, 0.01)});
  GpuSolver solver(model, sceneFor(model, 10, {}, Vector3d(0, 0, -9.81)));
  const auto run = [&] {
    for (int t = 0; t < 10; ++t) solver.step({});
    return stateHash(model, solver.readState());
  };
  const uint64_t rest = stateHash(model, solver.readState());
  const uint64_t first = run();
  EXPECT_NE(first, rest);
  solver.reset();
  EXPECT_EQ(stateHash(model, solver.readState()), rest);
  EXPECT_EQ(run(), first);
}

TEST_F(Integrate, HotLoopMakesNoOpenGlObject) {
  const Model model = modelOf({boxBody({4, 5, 6}, 0.01)});
  GpuSolver solver(model, sceneFor(model, 10, {StylusConfig{}}, Vector3d(0, 0, -9.81)));
  layout::TickStats stats;
  solver.step({});
  const size_t before = gpu::objectsCreated();
  for (int t = 0; t < 20; ++t) {
    solver.step({});
    solver.pollStats(stats, false);
  }
  EXPECT_EQ(gpu::objectsCreated(), before);
}

TEST_F(Integrate, TooManySubstepsAreRefusedWithWhatWouldDo) {
  Body body = boxBody({2, 2, 2}, 0.01);
  body.material.young_modulus_pa = 1e9;
  const Model model = modelOf({body});
  Scene scene = sceneFor(model, 10);
  scene.solver.tick_hz = 1;
  try {
    GpuSolver solver(model, scene);
    FAIL() << "accepted";
  } catch (const SceneError& e) {
    EXPECT_NE(std::string(e.what()).find("max_substeps"), std::string::npos) << e.what();
  }
}
