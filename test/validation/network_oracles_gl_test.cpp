// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
// Oracles of physics.md 6 on explicit connections, and the requirements of issue 5 on a cloth.
#include <numeric>

#include "solver/network_rig.h"
#include "solver/reference/statics.h"

using namespace viscera;
using namespace viscera::test;

namespace {

/// Returns the total energy from velocities of half a substep earlier [J]: kinetic 1/2 m v- . v+ (physics.md 6, oracle
/// 8).
double energyBetween(ReferenceSolver& reference, const HostState& state, double dt_s) {
  load(reference, state);
  const Field force_n = reference.elasticForces(reference.u_m);
  double kinetic_j = 0;
  for (uint32_t slot : reference.active) {
    if (isFixed(reference.nodes[slot])) continue;
    const Vector3d before = reference.v_m_per_s[slot];
    kinetic_j += 0.5 * reference.mass(slot) * before.dot(before + dt_s / reference.mass(slot) * force_n[slot]);
  }
  return kinetic_j + reference.elasticEnergy();
}

class NetworkOracle : public OnBackend {};

INSTANTIATE_TEST_SUITE_P(Backends, NetworkOracle, ::testing::ValuesIn(backendNames()), backendSuffix);

}  // namespace

/// Issue 5: cloth on four points sags as in the static solution of the reference.
TEST_P(NetworkOracle, ClothOnFourPointsSagsLikeTheStaticSolution) {
  constexpr double kSag = 1e-4;  // issue 5, relative
  Body cloth = clothBody(15, 13, 0.01, 0.1);
  cloth.material.mass_damping_per_s = 40;  // about twice the slowest frequency
  fixNearest(cloth, {{-1, -1, 0}, {1, -1, 0}, {-1, 1, 0}, {1, 1, 0}});
  const Model model = modelOf({cloth});
  const Vector3d gravity(0, 0, -9.81);
  ReferenceSolver reference(model, gravity, 1);
  Scene scene = sceneFor(model, 500, {}, gravity);
  const auto solver = make(model, scene);
  for (int t = 0; t < 20; ++t) solver->step({});
  const HostState state = solver->readState();
  // A sheet in compression may buckle in either direction. Start from a hollow far from the solution.
  for (uint32_t slot : reference.active) {
    if (!isFixed(reference.nodes[slot])) reference.u_m[slot] = Vector3d(0, 0, -1e-3);
  }
  solveStatics(reference, {});
  double sag_m = 0, true_sag_m = 0, error_m = 0;
  for (uint32_t slot : reference.active) {
    sag_m = std::max(sag_m, -static_cast<double>(state.displacement_m[slot].z));
    true_sag_m = std::max(true_sag_m, -reference.u_m[slot].z());
    error_m = std::max(error_m, (xyz(state.displacement_m[slot]) - reference.u_m[slot]).norm());
  }
  EXPECT_GT(true_sag_m, 0.01) << "it hangs";
  EXPECT_NEAR(sag_m, true_sag_m, kSag * true_sag_m);
  EXPECT_LT(error_m, kSag * true_sag_m);
}

/// A drum: cloth that is stretched over a rim. (A slack one is flat without stiffness; there leapfrog's own energy,
/// also in float64, varies by 2e-4 as its modes exchange energy.)
TEST_P(NetworkOracle, UndampedDrumKeepsTheEnergyOfItsSwing) {
  constexpr double kDrift = 1e-4;  // bound of issue 3, for lattices
  constexpr int kTicks = 200, kTickSubsteps = 100, kMeanTicks = 50;
  Body cloth = undamped(clothBody(8, 8, 0.01));
  for (uint32_t slot : cloth.lattice.active_slots) {
    if (restPosition(cloth, slot).cwiseAbs().maxCoeff() > 0.03) cloth.lattice.nodes[slot].lo |= layout::kFixedBit;
  }
  const Model model = modelOf({cloth});
  ReferenceSolver reference(model, Vector3d::Zero(), 1);
  for (uint32_t slot : reference.active) reference.u_m[slot] = 0.05 * reference.restPosition(slot);
  const double still_j = reference.elasticEnergy();
  HostState state = reference.state();
  for (uint32_t slot : cloth.lattice.active_slots) {
    const Vector3d x = restPosition(cloth, slot);
    if (isFixed(cloth.lattice.nodes[slot])) continue;
    state.velocity_m_per_s[slot] = vec4({0.02 * std::cos(40 * x.y()), 0, 0.05 * std::cos(30 * x.x())});
  }
  const auto solver = make(model, sceneFor(model, kTickSubsteps));
  solver->writeState(state);
  std::vector<double> energy_j;
  for (int t = 0; t < kTicks; ++t) {
    solver->step({});
    energy_j.push_back(energyBetween(reference, solver->readState(), solver->dt_s()) - still_j);
  }
  const auto mean = [&](int first, int last) {
    return std::accumulate(energy_j.begin() + first, energy_j.begin() + last, 0.0) / (last - first);
  };
  EXPECT_LT(std::abs(mean(kTicks - kMeanTicks, kTicks) / mean(0, kMeanTicks) - 1), kDrift);
}

TEST_P(NetworkOracle, FreeNetworkKeepsItsMomentum) {
  constexpr double kMomentum = 1e-6;  // of the sum of magnitudes: bound of issue 3, for lattices
  GraphOptions options;
  options.prestrain = 0.05;
  const Model model = modelOf({undamped(graphBody(200, 700, 8, options))});
  Scene scene = sceneFor(model, 200);
  const auto solver = make(model, scene);
  const HostState start = scatteredState(model, 1e-3, 0.1, 3);
  solver->writeState(start);
  ReferenceSolver reference(model, Vector3d::Zero(), 1);
  load(reference, start);
  const Vector3d before = reference.momentum();
  for (int t = 0; t < 5; ++t) solver->step({});
  load(reference, solver->readState());
  double sizes = 0;
  for (uint32_t slot : reference.active) sizes += reference.mass(slot) * reference.v_m_per_s[slot].norm();
  EXPECT_LT((reference.momentum() - before).norm(), kMomentum * sizes);
}
