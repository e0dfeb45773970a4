// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
// Exact oracles of physics.md 6 on explicit connections, and what issue 5 asks of a cloth.
#include <numeric>

#include "solver/network_rig.h"
#include "solver/reference/statics.h"

using namespace viscera;
using namespace viscera::test;

namespace {

constexpr double kStiffness_n_per_m = 20, kMass_kg = 2e-3, kLength_m = 0.01;

/// Nodes along z, kLength_m apart, in slots of the same order; the first of them is fixed, and the last if so asked.
Body chain(int nodes, bool last_fixed) {
  SpringNetwork network;
  for (int i = 0; i < nodes; ++i) {
    network.positions_m.emplace_back(0, 0, kLength_m * i);
    network.masses_kg.push_back(kMass_kg);
    if (i > 0)
      network.springs.push_back(
          {static_cast<uint32_t>(i - 1), static_cast<uint32_t>(i), kStiffness_n_per_m, kLength_m});
  }
  Body body;
  body.name = "chain";
  adoptNetwork(network, body);
  const Vector3d last(0, 0, kLength_m * (nodes - 1));
  fixNearest(body,
             last_fixed ? std::vector<Vector3d>{Vector3d::Zero(), last} : std::vector<Vector3d>{Vector3d::Zero()});
  return undamped(body);
}

int placeOf(const Body& body, uint32_t slot) {
  return static_cast<int>(std::lround(restPosition(body, slot).z() / kLength_m));
}

/// Total energy from velocities of half a substep before [J]: kinetic 1/2 m v- . v+ (physics.md 6, oracle 8).
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

/// Oracle 3: the first node holds, the others hang.
TEST_P(NetworkOracle, HangingChainSagsExactly) {
  constexpr int kMasses = 10;
  constexpr double kGravity = 9.81;
  Body body = chain(kMasses + 1, false);
  // 2 omega_1 settles fastest.
  body.material.drag_per_s = 4 * std::sqrt(kStiffness_n_per_m / kMass_kg) * std::sin(M_PI / (4.0 * kMasses + 2));
  const Model model = modelOf({body});
  Scene scene = sceneFor(model, 100, {}, Vector3d(0, 0, kGravity));
  const auto solver = make(model, scene);
  for (int t = 0; t < 60; ++t) solver->step({});
  const HostState state = solver->readState();
  const double unit = kMass_kg * kGravity / kStiffness_n_per_m;
  const double deepest = unit * (kMasses * kMasses - kMasses * (kMasses - 1) / 2.0);
  for (uint32_t slot : body.lattice.active_slots) {
    const int j = placeOf(body, slot);
    EXPECT_NEAR(state.displacement_m[slot].z, unit * (kMasses * j - j * (j - 1) / 2.0), 1e-5 * deepest) << "mass " << j;
  }
}

/// Oracle 2, fixed-fixed: along the chain every mode swings as an oscillator of its own, u_n = A cos(n theta) with
/// cos(theta) = 1 - (omega dt)^2 / 2 and omega = 2 sqrt(k/m) sin(p pi / (2 (N + 1))).
TEST_P(NetworkOracle, ModesOfAChainSwingAtTheirExactFrequencies) {
  constexpr int kMasses = 9, kSteps = 300;
  constexpr double kAmplitude_m = 1e-3;
  const Body body = chain(kMasses + 2, true);
  const Model model = modelOf({body});
  Scene scene = sceneFor(model, 1);
  const auto solver = make(model, scene);
  const double dt = solver->dt_s();
  for (int p : {1, 4, kMasses}) {
    const double omega = 2 * std::sqrt(kStiffness_n_per_m / kMass_kg) * std::sin(p * M_PI / (2.0 * (kMasses + 1)));
    const double theta = std::acos(1 - 0.5 * omega * omega * dt * dt);
    const auto exact = [&](uint32_t slot, int n) {
      return kAmplitude_m * std::sin(p * M_PI * placeOf(body, slot) / (kMasses + 1)) * std::cos(n * theta);
    };
    HostState state = restState(model);
    for (uint32_t slot : body.lattice.active_slots) {
      if (isFixed(body.lattice.nodes[slot])) continue;
      state.displacement_m[slot].z = static_cast<float>(exact(slot, 0));
      state.velocity_m_per_s[slot].z = static_cast<float>((exact(slot, 0) - exact(slot, -1)) / dt);
    }
    solver->writeState(state, true);
    double worst = 0;
    for (int n = 1; n <= kSteps; ++n) {
      solver->step({});
      state = solver->readState();
      for (uint32_t slot : body.lattice.active_slots) {
        worst = std::max(worst, std::abs(state.displacement_m[slot].z - exact(slot, n)));
      }
    }
    // Roundings of 300 substeps, and k, m and dt as float32 numbers: a phase error of 1e-7 per radian.
    EXPECT_LT(worst / kAmplitude_m, 3e-5) << "mode " << p << ", ";
  }
}

/// A sheet of equilateral triangles is a plate of modulus E, thickness t and nu = 1/3 (membraneNetwork).
TEST_P(NetworkOracle, StretchedSheetPullsWithItsModulusAndIsFreeOfForceInside) {
  constexpr double kStrain = 1e-4, kSpacing_m = 0.01, kThickness_m = 1e-3;
  constexpr double kSecondOrder = 10 * kStrain;  // springs turn: finite strain
  const Body body = undamped(clothBody(9, 14, kSpacing_m, 0, kThickness_m));
  const Model model = modelOf({body});
  HostState state = restState(model);
  Eigen::AlignedBox3d box;
  for (uint32_t slot : body.lattice.active_slots) {
    const Vector3d x = restPosition(body, slot);
    box.extend(x);
    state.displacement_m[slot] = vec4(kStrain * Vector3d(x.x(), -x.y() / 3, 0));
  }
  const double load_n = body.material.young_modulus_pa * kThickness_m * box.sizes().y() * kStrain;
  const std::vector<Vector3d> force_n = forcesOf(GetParam(), model, state);
  double pull_n = 0;
  for (uint32_t slot : body.lattice.active_slots) {
    const double x = restPosition(body, slot).x();
    if (x < 0) pull_n += force_n[slot].x();
    if (x < box.min().x() + 0.6 * kSpacing_m || x > box.max().x() - 0.6 * kSpacing_m) continue;
    EXPECT_LT(force_n[slot].norm(), kSecondOrder * load_n);
  }
  EXPECT_NEAR(pull_n, load_n, kSecondOrder * load_n);
}

/// Issue 5: cloth on four points sags as the static solution of the reference does.
TEST_P(NetworkOracle, ClothOnFourPointsSagsLikeTheStaticSolution) {
  constexpr double kSag = 1e-4;  // issue 5, relative
  Body cloth = clothBody(15, 13, 0.01, 0.1);
  cloth.material.drag_per_s = 40;  // about twice the slowest frequency
  fixNearest(cloth, {{-1, -1, 0}, {1, -1, 0}, {-1, 1, 0}, {1, 1, 0}});
  const Model model = modelOf({cloth});
  const Vector3d gravity(0, 0, -9.81);
  ReferenceSolver reference(model, gravity, 1);
  Scene scene = sceneFor(model, 500, {}, gravity);
  const auto solver = make(model, scene);
  for (int t = 0; t < 20; ++t) solver->step({});
  const HostState state = solver->readState();
  // A sheet in compression may buckle either way. Start from a hollow that is nothing like the solution.
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

/// A drum: cloth that is stretched over a rim. (A slack one lies flat without stiffness; there leapfrog's own energy,
/// in float64 too, comes and goes by 2e-4 with what its modes exchange.)
TEST_P(NetworkOracle, UndampedDrumKeepsTheEnergyOfItsSwing) {
  constexpr double kDrift = 1e-4;  // issue 3's bound, for lattices
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
  constexpr double kMomentum = 1e-6;  // of the sum of sizes: issue 3's bound, for lattices
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
