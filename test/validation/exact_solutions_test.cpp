// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
// Exact solutions of physics.md 6, on the float64 reference and on every backend's float32 state.
#include "solver/network_rig.h"
#include "solver/reference/reference_bodies.h"
#include "solver/reference/statics.h"

using namespace viscera;
using namespace viscera::test;

namespace {

const char* const kReference = "reference";

std::vector<std::string> systems() {
  std::vector<std::string> out = backendNames();
  out.emplace_back(kReference);
  return out;
}

/// Unit masses along z on springs, the first of them fixed, and the last on request.
struct MassChain {
  std::string name;
  Body body;
  double stiffness_n_per_m, length_m;

  /// Returns the number of a node from the fixed end.
  int numberOf(uint32_t slot) const { return static_cast<int>(std::lround(restPosition(body, slot).z() / length_m)); }
};

std::vector<MassChain> chains(int nodes, bool last_fixed) {
  MassChain lattice{"lattice", unitChain(nodes), 1, 1}, links{"links", {}, 3, 0.5};
  SpringNetwork network;
  for (int i = 0; i < nodes; ++i) {
    network.positions_m.emplace_back(0, 0, links.length_m * i);
    network.masses_kg.push_back(1);
    if (i > 0) network.springs.push_back({static_cast<uint32_t>(i - 1), static_cast<uint32_t>(i), 3, links.length_m});
  }
  links.body.name = "chain";
  adoptNetwork(network, links.body);
  links.body = undamped(links.body);
  std::vector<MassChain> out = {lattice, links};
  for (MassChain& chain : out) {
    for (const uint32_t slot : chain.body.lattice.active_slots) {
      const int number = chain.numberOf(slot);
      if (number == 0 || (last_fixed && number == nodes - 1)) chain.body.lattice.nodes[slot].lo |= layout::kFixedBit;
    }
  }
  return out;
}

template <class Displacement>
Field fieldOf(const Body& body, const Displacement& displacement) {
  Field out(body.lattice.nodes.size(), Vector3d::Zero());
  for (const uint32_t slot : body.lattice.active_slots) out[slot] = displacement(restPosition(body, slot));
  return out;
}

class Exact : public OnBackend {
 protected:
  bool isReference() const { return GetParam() == kReference; }
  double within(double float32, double float64) const { return isReference() ? float64 : float32; }

  static HostState stateOf(const Model& model, const Field& u_m) {
    HostState state = restState(model);
    for (size_t slot = 0; slot < u_m.size(); ++slot) state.displacement_m[slot] = vec4(u_m[slot]);
    return state;
  }
  /// Returns [slots, N] the forces on free nodes, at rest, without drag and gravity.
  Field forces(const Model& model, const Field& u_m) const {
    if (isReference()) return ReferenceLattice(model).elasticForces(u_m);
    return forcesOf(GetParam(), model, stateOf(model, u_m));
  }
  /// Returns [slots, m] the displacements in equilibrium.
  Field hung(const Model& model, const Vector3d& gravity_m_per_s2) const {
    if (isReference()) {
      ReferenceSolver solver(model, gravity_m_per_s2, 1);
      EXPECT_LE(solveStatics(solver, {}).residual, 1e-10);
      return solver.u_m;
    }
    const auto solver = make(model, sceneFor(model, 100, {}, gravity_m_per_s2));
    for (int t = 0; t < 60; ++t) solver->step({});
    Field out;
    for (const layout::vec4& u : solver->readState().displacement_m) out.push_back(xyz(u));
    return out;
  }
  /// Releases a body from rest. Calls visit(n, dt_s, z of a slot) after each substep n of 1 to `count`.
  template <class Visit>
  void swing(const Model& model, const Field& u_m, int count, const Visit& visit) const {
    if (isReference()) {
      const double dt_s = 0.5 * safeTimeStep(model);
      ReferenceSolver solver(model, Vector3d::Zero(), dt_s);
      solver.u_m = u_m;
      for (int n = 1; n <= count; ++n) {
        solver.substep();
        visit(n, dt_s, [&](uint32_t slot) { return solver.u_m[slot].z(); });
      }
      return;
    }
    const auto solver = make(model, sceneFor(model, 1));
    solver->writeState(stateOf(model, u_m));
    for (int n = 1; n <= count; ++n) {
      solver->step({});
      const HostState state = solver->readState();
      visit(n, solver->dt_s(), [&](uint32_t slot) { return static_cast<double>(state.displacement_m[slot].z); });
    }
  }
};

INSTANTIATE_TEST_SUITE_P(Systems, Exact, ::testing::ValuesIn(systems()), backendSuffix);

}  // namespace

/// Oracle 3: the first node is fixed, the others hang.
TEST_P(Exact, ChainsHang) {
  constexpr int kMasses = 10;
  constexpr double kGravity = 0.01;
  for (MassChain& chain : chains(kMasses + 1, false)) {
    // 2 omega_1 settles fastest.
    chain.body.material.mass_damping_per_s =
        4 * std::sqrt(chain.stiffness_n_per_m) * std::sin(M_PI / (4.0 * kMasses + 2));
    const Field u_m = hung(modelOf({chain.body}), Vector3d(0, 0, kGravity));
    const auto exact = [&](int j) { return kGravity / chain.stiffness_n_per_m * (kMasses * j - j * (j - 1) / 2.0); };
    for (const uint32_t slot : chain.body.lattice.active_slots) {
      const int j = chain.numberOf(slot);
      EXPECT_NEAR(u_m[slot].z(), exact(j), within(1e-5 * exact(kMasses), 1e-9)) << chain.name << ", mass " << j;
    }
  }
}

/// Oracle 2, fixed-fixed: along the chain every mode is an independent oscillator, u_n = A cos(n theta) with cos(theta)
/// = 1 - (omega dt)^2 / 2 and omega = 2 sqrt(k/m) sin(p pi / (2 (N + 1))).
TEST_P(Exact, ChainsSwing) {
  constexpr int kMasses = 9, kSteps = 300;
  for (const MassChain& chain : chains(kMasses + 2, true)) {
    const Model model = modelOf({chain.body});
    const double amplitude_m = 0.1 * chain.length_m;
    for (const int p : {1, 4, kMasses}) {
      const double omega = 2 * std::sqrt(chain.stiffness_n_per_m) * std::sin(p * M_PI / (2.0 * (kMasses + 1)));
      const auto shape = [&](const Vector3d& x) {
        return Vector3d(0, 0, amplitude_m * std::sin(p * M_PI * x.z() / (chain.length_m * (kMasses + 1))));
      };
      const Field start_m = fieldOf(chain.body, shape);
      double worst_m = 0;
      swing(model, start_m, kSteps, [&](int n, double dt_s, const auto& z_m) {
        const double theta = std::acos(1 - 0.5 * omega * omega * dt_s * dt_s);
        for (const uint32_t slot : chain.body.lattice.active_slots)
          worst_m = std::max(worst_m, std::abs(z_m(slot) - start_m[slot].z() * std::cos(n * theta)));
      });
      // Roundings of 300 substeps, and k, m and dt as float32 numbers: a phase error of 1e-7 per radian.
      EXPECT_LT(worst_m / amplitude_m, within(3e-5, 1e-10)) << chain.name << ", mode " << p;
    }
  }
}

TEST_P(Exact, AffineDisplacementGivesNoForceInside) {
  const Body body = unitBody({6, 6, 6});
  Eigen::Matrix3d gradient;
  gradient << 0.02, 0.01, -0.015, 0.005, -0.03, 0.02, 0.01, 0.015, 0.025;
  const Field force_n =
      forces(modelOf({body}), fieldOf(body, [&](const Vector3d& x) { return Vector3d(gradient * x); }));
  for (const uint32_t slot : body.lattice.active_slots) {
    const Eigen::Array3i n = body.lattice.nodeAt(slot).array();
    if ((n == 0).any() || (n == 6).any()) continue;
    EXPECT_LT(force_n[slot].norm(), within(2e-6, 1e-13));  // of k h: float32 rounding of displacements up to 0.3 h
  }
}

TEST_P(Exact, RigidMotionGivesNoForceAnywhere) {
  const Body body = unitBody({5, 4, 6});
  const Quaterniond turn = rotationFromDegrees({35, -50, 110});
  const auto moved = [&](const Vector3d& x) { return Vector3d(turn * x + Vector3d(1.5, -2, 0.7) - x); };
  for (const Vector3d& force : forces(modelOf({body}), fieldOf(body, moved)))
    EXPECT_LT(force.norm(), within(2e-5, 1e-12));  // in units of k h: float32 of u up to 10 h
}

/// A sheet of equilateral triangles is a plate of modulus E, thickness t and nu = 1/3 (membraneNetwork).
TEST_P(Exact, StretchedSheetPullsWithItsModulusAndIsFreeOfForceInside) {
  constexpr double kStrain = 1e-4, kSpacing_m = 0.01, kThickness_m = 1e-3;
  constexpr double kSecondOrder = 10 * kStrain;  // springs rotate: finite strain
  const Body body = undamped(clothBody(9, 14, kSpacing_m, 0, kThickness_m));
  Eigen::AlignedBox3d box;
  for (const uint32_t slot : body.lattice.active_slots) box.extend(restPosition(body, slot));
  const Field force_n =
      forces(modelOf({body}),
             fieldOf(body, [&](const Vector3d& x) { return Vector3d(kStrain * Vector3d(x.x(), -x.y() / 3, 0)); }));
  const double load_n = body.material.young_modulus_pa * kThickness_m * box.sizes().y() * kStrain;
  double pull_n = 0;
  for (const uint32_t slot : body.lattice.active_slots) {
    const double x = restPosition(body, slot).x();
    if (x < 0) pull_n += force_n[slot].x();
    if (x < box.min().x() + 0.6 * kSpacing_m || x > box.max().x() - 0.6 * kSpacing_m) continue;
    EXPECT_LT(force_n[slot].norm(), kSecondOrder * load_n);
  }
  EXPECT_NEAR(pull_n, load_n, kSecondOrder * load_n);
}
