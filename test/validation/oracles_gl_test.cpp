// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
// Oracles of physics.md 6 for backends only; those that also test the reference are in exact_solutions_test.cpp.
#include "solver/network_rig.h"
#include "solver/reference/reference_bodies.h"

using namespace viscera;
using namespace viscera::test;

namespace {

class Oracle : public OnBackend {};

INSTANTIATE_TEST_SUITE_P(Backends, Oracle, ::testing::ValuesIn(backendNames()), backendSuffix);

}  // namespace

TEST_P(Oracle, DampedOscillatorFollowsItsDiscreteSolution) {
  Body body = chainBody(2, 0.01);
  body.lattice.nodes[slotAt(body, 0, 0, 0)].lo |= layout::kFixedBit;
  body.material.stiffness_damping_ratio = 0;
  body.material.mass_damping_per_s = 40;
  const Model model = modelOf({body});
  const auto solver = make(model, sceneFor(model, 1));
  const layout::BodyParams params = bodyParams(body, 0);
  const double dt = solver->dt_s(), omega2 = 4.0 * params.axial_quarter_n_per_m / (8.0 * params.mass_eighth_kg);
  const double g = body.material.mass_damping_per_s * dt, o2 = omega2 * dt * dt;
  const double radius = std::sqrt((1 - g / 2) / (1 + g / 2));
  const double theta = std::acos((1 - o2 / 2) / std::sqrt(1 - g * g / 4));
  const double amplitude = 1e-3;
  const auto exact = [&](int n) { return amplitude * std::pow(radius, n) * std::cos(n * theta); };
  HostState state = restState(model);
  const uint32_t free = slotAt(body, 0, 0, 1);
  state.displacement_m[free].z = static_cast<float>(exact(0));
  state.velocity_m_per_s[free].z = static_cast<float>((exact(0) - exact(-1)) / dt);
  solver->writeState(state, true);
  double worst = 0;
  for (int n = 1; n <= 300; ++n) {
    solver->step({});
    worst = std::max(worst, std::abs(solver->readState().displacement_m[free].z - exact(n)));
  }
  EXPECT_LT(worst / amplitude, 1e-5);  // float32 roundings and the float32 values of k, m, dt over 300 steps
}

TEST_P(Oracle, ForcesSumToNothing) {
  const Body body = undamped(boxBody({7, 6, 5}, 0.01));
  const Model model = modelOf({body});
  std::mt19937 random(2);
  HostState state = restState(model);
  for (uint32_t slot : body.lattice.active_slots) state.displacement_m[slot] = vec4(randomVector(random, 0.003));
  Vector3d sum = Vector3d::Zero();
  double size = 0;
  for (const Vector3d& force : forcesOf(GetParam(), model, state)) {
    sum += force;
    size += force.norm();
  }
  EXPECT_LT(sum.norm() / size, 1e-6);
}

TEST_P(Oracle, GatheredPairForcesAreAntisymmetricToTheBit) {
  std::mt19937 random(3);
  for (uint32_t spring = 0; spring < layout::kSpringsPerNode; spring += 2) {
    for (int trial = 0; trial < 20; ++trial) {
      Body body = undamped(boxBody({4, 4, 4}, 0.01));
      Lattice& lattice = body.lattice;
      const Vector3i near(2, 2, 2);
      const auto& o = kNeighborOffsets[spring];
      const uint32_t a = slotAt(body, 2, 2, 2),
                     b = static_cast<uint32_t>(lattice.slotAt(near + Vector3i(o[0], o[1], o[2])));
      for (layout::NodeBits& bits : lattice.nodes) bits = {};
      lattice.nodes[a].lo = lattice.nodes[b].lo = 8u << layout::kMassShift;
      setSpringCount(lattice.nodes[a], spring, 2);
      setSpringCount(lattice.nodes[b], oppositeSpring(spring), 2);
      lattice.active_slots = {std::min(a, b), std::max(a, b)};
      const Model model = modelOf({body});
      HostState state = restState(model);
      state.displacement_m[a] = vec4(randomVector(random, 0.02));
      state.displacement_m[b] = vec4(randomVector(random, 0.02));
      const auto solver = make(model, sceneFor(model, 1));
      solver->writeState(state);
      solver->step({});
      const HostState after = solver->readState();
      ASSERT_NE(after.velocity_m_per_s[a].x, 0.0f);
      EXPECT_EQ(after.velocity_m_per_s[a].x, -after.velocity_m_per_s[b].x);
      EXPECT_EQ(after.velocity_m_per_s[a].y, -after.velocity_m_per_s[b].y);
      EXPECT_EQ(after.velocity_m_per_s[a].z, -after.velocity_m_per_s[b].z);
    }
  }
}

TEST_P(Oracle, FiniteUniaxialStretchHasTheExactLateralStrainAndStress) {
  struct Row {
    double stretch, lateral, stress;
  };
  // physics.md 6, oracle 5: k = h = 1
  const Row table[] = {{0.9, 1.02509614, -0.23220140}, {1.01, 0.99750205, 0.02517550}, {1.1, 0.97528475, 0.26725437},
                       {1.5, 0.88822938, 1.63251783},  {2, 0.81303026, 3.75959822},    {10, 0.63589939, 43.35454844}};
  for (const Vector3i& cells : {Vector3i(4, 1, 1), Vector3i(5, 3, 2)}) {
    const Body body = unitBody(cells);
    const Model model = modelOf({body});
    for (const Row& row : table) {
      HostState state = restState(model);
      for (uint32_t slot : body.lattice.active_slots) {
        const Vector3d rest = body.lattice.restPosition(slot);
        state.displacement_m[slot] =
            vec4(Vector3d((row.stretch - 1) * rest.x(), (row.lateral - 1) * rest.y(), (row.lateral - 1) * rest.z()));
      }
      const std::vector<Vector3d> forces = forcesOf(GetParam(), model, state);
      double pull = 0, loose = 0;
      for (uint32_t slot : body.lattice.active_slots) {
        const int x = body.lattice.nodeAt(slot).x();
        if (x == 0) pull += forces[slot].x();
        loose = std::max(
            loose, (x == 0 || x == cells.x() ? Vector3d(0, forces[slot].y(), forces[slot].z()) : forces[slot]).norm());
      }
      const double tolerance = 1e-6 * std::max(1.0, row.stretch * row.stretch);  // float32 of u up to (a - 1) * 5 h
      EXPECT_NEAR(pull / (cells.y() * cells.z()), row.stress, 4 * tolerance) << "stretch " << row.stretch;
      EXPECT_LT(loose, 4 * tolerance) << "stretch " << row.stretch;
    }
  }
}
