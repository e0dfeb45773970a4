// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>

#include "support/random_state.h"
#include "support/solver_rig.h"
#include "support/text.h"
#include "viscera/math/error.h"
#include "viscera/solver/material.h"

using namespace viscera;
using namespace viscera::test;

namespace {

// Relative to the largest value: float32 rounds at 6e-8, and some twenty roundings per substep add up over ten
// substeps.
constexpr double kFloat32Displacement = 1e-6;
constexpr double kFloat32Velocity = 5e-6;
constexpr int kSubsteps = 10;

class Integrate : public OnBackend {
 protected:
  void expectLikeReference(const Model& model, const Vector3d& gravity) {
    const Scene scene = sceneFor(model, kSubsteps, {}, gravity);
    const auto solver = make(model, scene);
    ReferenceSolver reference(model, gravity, static_cast<float>(solver->dt_s()));
    expectSameTick(*solver, reference, randomState(model, 0.05 * model.bodies[0].lattice.spacing_m, 0.1, 7),
                   kFloat32Displacement, kFloat32Velocity);
  }
  /// Makes one substep from a state far from rest and compares it with the reference.
  void expectSameSubstep(const Model& model, const HostState& start) {
    const auto solver = make(model, sceneFor(model, 1));
    solver->writeState(start);
    ReferenceSolver reference(model, Vector3d::Zero(), static_cast<float>(solver->dt_s()));
    load(reference, start);
    solver->step({});
    reference.substep();
    EXPECT_LT(relativeError(solver->readState().velocity_m_per_s, reference.v_m_per_s, reference.active),
              kFloat32Velocity);
  }
};

INSTANTIATE_TEST_SUITE_P(Backends, Integrate, ::testing::ValuesIn(backendNames()), backendSuffix);

}  // namespace

TEST_P(Integrate, MatchesReferenceAtEverySize) {
  for (size_t size : kSizes) {
    SCOPED_TRACE(size);
    Body body = blobBody(size, 0.01, 3);
    body.material.stiffness_damping_ratio = 0;
    expectLikeReference(modelOf({body}), Vector3d(0.3, -0.2, -9.81));
  }
}

TEST_P(Integrate, MatchesReferenceWithDashpotAndDrag) {
  for (size_t size : kSizes) {
    SCOPED_TRACE(size);
    Body body = blobBody(size, 0.01, 4);
    body.material.stiffness_damping_ratio = 0.2;
    body.material.mass_damping_per_s = 50;
    expectLikeReference(modelOf({body}), Vector3d::Zero());
  }
}

/// A free cell that breathes: by symmetry u = e (x - middle) is a mode. Its energy decreases by tau omega^2 per second,
/// with tau of the dashpots: c = tau k.
TEST_P(Integrate, ADashpotTakesFromAModeWhatItsFrequencySays) {
  constexpr int kTicks = 600;
  // The velocity is half a substep old, at most z/2 = 0.02 of the energy at either end, of which more than e^2 is lost.
  constexpr double kLogarithm = 0.04;
  Body body = boxBody({1, 1, 1}, 0.01);
  body.material.mass_damping_per_s = 0;
  body.material.stiffness_damping_ratio = 0.2;
  const Model model = modelOf({body});
  Scene scene = sceneFor(model, kSubsteps);
  scene.solver.tick_hz *= 200;  // substeps so short that the time between them does not matter
  const auto solver = make(model, scene);
  HostState state = restState(model);
  const Vector3d middle = Vector3d::Constant(0.005) + body.lattice.origin_m;
  for (uint32_t slot : body.lattice.active_slots)
    state.displacement_m[slot] = vec4(1e-4 * (body.lattice.restPosition(slot) - middle));
  solver->writeState(state);
  ReferenceSolver reference(model, Vector3d::Zero(), solver->dt_s());
  load(reference, state);
  const uint32_t corner = body.lattice.active_slots[0];
  const double omega2 = reference.force(corner).norm() / (reference.mass(corner) * reference.u_m[corner].norm());
  const double before = reference.energy();
  for (int t = 0; t < kTicks; ++t) solver->step({});
  load(reference, solver->readState());
  const double tau_s = bodyParams(model.bodies[0], safeTimeStep(model)).dashpot_s;
  const double lost = tau_s * omega2 * kTicks * solver->substeps() * solver->dt_s();
  ASSERT_GT(lost, 2);
  EXPECT_NEAR(std::log(before / reference.energy()) / lost, 1, kLogarithm);
}

/// Springs that act at the predicted positions of their ends are central there, not at the current ones. A free block
/// that rotates at omega loses tau omega^2 of its angular momentum per second, and nothing else. Momentum is conserved.
TEST_P(Integrate, PredictedSpringsKeepMomentumAndSlowATurnBySoMuch) {
  constexpr double kTurn_per_s = 10;
  constexpr int kTicks = 100;
  constexpr double kRounding = 1e-5;  // of float32 sums over the block
  Body body = boxBody({3, 4, 3}, 0.01);
  body.material.mass_damping_per_s = 0;
  body.material.stiffness_damping_ratio = 0.2;
  const Model model = modelOf({body});
  const auto solver = make(model, sceneFor(model, kSubsteps));
  ReferenceSolver reference(model, Vector3d::Zero(), solver->dt_s());
  Vector3d middle = Vector3d::Zero();
  double mass_kg = 0;
  for (uint32_t slot : reference.active) {
    middle += reference.mass(slot) * reference.restPosition(slot);
    mass_kg += reference.mass(slot);
  }
  middle /= mass_kg;
  HostState state = restState(model);
  const Vector3d along(0.3, 0, -0.2);  // [m/s]
  for (uint32_t slot : reference.active)
    state.velocity_m_per_s[slot] =
        vec4(along + Vector3d(0, 0, kTurn_per_s).cross(reference.restPosition(slot) - middle));
  const auto angular = [&] {
    Vector3d at = Vector3d::Zero(), sum = Vector3d::Zero();
    for (uint32_t slot : reference.active)
      at += reference.mass(slot) / mass_kg * (reference.restPosition(slot) + reference.u_m[slot]);
    for (uint32_t slot : reference.active)
      sum += reference.mass(slot) *
             (reference.restPosition(slot) + reference.u_m[slot] - at).cross(reference.v_m_per_s[slot]);
    return sum.z();
  };
  load(reference, state);
  solver->writeState(state);
  solver->step({});  // velocities are half a substep old from here on
  load(reference, solver->readState());
  const double before = angular();
  for (int t = 0; t < kTicks; ++t) solver->step({});
  load(reference, solver->readState());
  EXPECT_LT((reference.momentum() - mass_kg * along).norm(), kRounding * mass_kg * along.norm());
  const double tau_s = bodyParams(model.bodies[0], safeTimeStep(model)).dashpot_s;
  const double lost = tau_s * kTurn_per_s * kTurn_per_s * kTicks * solver->substeps() * solver->dt_s();
  EXPECT_NEAR(std::log(before / angular()) / lost, 1, 0.1);
}

TEST_P(Integrate, MatchesReferenceOfABlock) {
  expectLikeReference(modelOf({boxBody({5, 6, 4}, 0.01)}), Vector3d(0.3, -0.2, -9.81));
}

TEST_P(Integrate, SpringsFarFromRestMatchTheReference) {
  const Model model = modelOf({boxBody({4, 4, 4}, 0.01)});
  expectSameSubstep(model, randomState(model, 0.02, 1, 5));
}

TEST_P(Integrate, MatchesReferenceWithPartsAndTheirInterface) {
  Body body = boxBody({6, 5, 5}, 0.01);
  body.lattice.part_names = {"wall", "valve"};
  for (uint32_t slot = 0; slot < body.lattice.nodes.size(); ++slot) {
    uint16_t& label = body.lattice.cell_labels[slot];
    if (label && body.lattice.nodeAt(slot).x() >= 3) label = 2;
  }
  body.parts = {{"valve", 200e3, 0.25, 3000}};
  for (const Weights weights : {Weights::kCell, Weights::kPaper}) {
    body.material.weights = weights;
    expectLikeReference(modelOf({body}), Vector3d(0, 0, -9.81));
  }
}

/// A body that moves without strain: u is a sum of equal increments.
TEST_P(Integrate, ShortSubstepsLoseNoDigitsOfU) {
  constexpr int kTicks = 20, kShortSubsteps = 250;
  // Two roundings of float32 in dt and in dt v, which every increment shares, and one of the sum. Without compensation
  // 5000 sums lose 1e-5 and more.
  constexpr double kSharedRoundings = 3.0 / (1 << 24);
  Body body = boxBody({2, 2, 2}, 0.01);
  body.material.young_modulus_pa = 50e6;
  body.material.mass_damping_per_s = 0;
  const Model model = modelOf({body});
  const auto solver = make(model, sceneFor(model, kShortSubsteps));
  ASSERT_LT(solver->dt_s(), kShortSubstep_s);
  HostState state = restState(model);
  const float speed_m_per_s = 0.1f;
  for (uint32_t slot : body.lattice.active_slots) state.velocity_m_per_s[slot] = {speed_m_per_s, 0, 0, 0};
  solver->writeState(state);
  for (int t = 0; t < kTicks; ++t) solver->step({});
  const double truth_m = kTicks * kShortSubsteps * solver->dt_s() * speed_m_per_s;
  const HostState end = solver->readState();
  for (uint32_t slot : body.lattice.active_slots) {
    EXPECT_NEAR(end.displacement_m[slot].x, truth_m, kSharedRoundings * truth_m);
  }
}

TEST_P(Integrate, BodiesDoNotFeelEachOther) {
  Body soft = boxBody({3, 3, 3}, 0.01), stiff = boxBody({5, 2, 4}, 0.02);
  stiff.material.young_modulus_pa = 5 * soft.material.young_modulus_pa;
  expectLikeReference(modelOf({soft, stiff}), Vector3d(0, 0, -9.81));
}

TEST_P(Integrate, FixedNodesStay) {
  Body body = boxBody({4, 4, 4}, 0.01);
  for (uint32_t slot : body.lattice.active_slots) {
    if (body.lattice.nodeAt(slot).z() == 4) body.lattice.nodes[slot].lo |= layout::kFixedBit;
  }
  const Model model = modelOf({body});
  const auto solver = make(model, sceneFor(model, 50, {}, Vector3d(0, 0, -9.81)));
  for (int t = 0; t < 20; ++t) solver->step({});
  const HostState state = solver->readState();
  for (uint32_t slot : body.lattice.active_slots) {
    const Vector3d u = xyz(state.displacement_m[slot]);
    if (isFixed(body.lattice.nodes[slot])) {
      EXPECT_EQ(u, Vector3d::Zero().eval());
    } else {
      EXPECT_LT(u.z(), 0);
    }
  }
}

TEST_P(Integrate, ResetRestoresTheHash) {
  const Model model = modelOf({boxBody({4, 5, 6}, 0.01)});
  const auto solver = make(model, sceneFor(model, 10, {}, Vector3d(0, 0, -9.81)));
  expectResetRestoresTheHash(*solver, model, 10);
}

TEST_P(Integrate, TooManySubstepsAreRefusedWithWhatWouldDo) {
  Body body = boxBody({2, 2, 2}, 0.01);
  body.material.young_modulus_pa = 1e9;
  const Model model = modelOf({body});
  Scene scene = sceneFor(model, 10);
  scene.solver.tick_hz = 1;
  EXPECT_TRUE(says(messageOf<SceneError>([&] { make(model, scene); }), {"max_substeps"}));
}
