// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
// Probes and obstacles are part of the solution of an implicit substep: their forces do not depend on its length.
#include "model/scene/integrators.h"
#include "solver/contact/environment.h"
#include "solver/reference/statics.h"
#include "support/random_state.h"
#include "support/solver_rig.h"

using namespace viscera;
using namespace viscera::test;

namespace {

constexpr double kImplicitContactSpacing_m = 0.01;
// Of the force of the static equilibrium, as promised. The rest is rounding of tools' positions, and remaining
// iteration error.
constexpr double kImplicitContactForce = 0.01;

struct Variant {
  Integrator integrator;
  double fraction;  ///< over dt_safe
};
constexpr Variant kVariants[] = {
    {Integrator::kLeapfrog, 0.5}, {Integrator::kPd, 2}, {Integrator::kPd, 5}, {Integrator::kPd, 10}};
constexpr int kIterations = 20;  // the default: a state at rest is the solution, however few

class ImplicitContact : public OnBackend {
 protected:
  static std::vector<Variant> variants() { return {std::begin(kVariants), std::end(kVariants)}; }
};

INSTANTIATE_TEST_SUITE_P(Backends, ImplicitContact, ::testing::ValuesIn(backendKinds()), backendSuffix);

void fixBottom(Body& body) {
  for (uint32_t slot : body.lattice.active_slots) {
    if (body.lattice.nodeAt(slot).z() == 0) body.lattice.nodes[slot].lo |= layout::kFixedBit;
  }
}

uint32_t slotOf(const Body& body, const Vector3i& node) {
  for (uint32_t slot : body.lattice.active_slots) {
    if (body.lattice.nodeAt(slot) == node) return slot;
  }
  return 0;
}

ObstacleConfig planeAt(double z_m) {
  ObstacleConfig out;
  out.shape = ObstacleShape::kPlane;
  out.position_m = Vector3d(0, 0, z_m);
  out.friction = 0;
  return out;
}

}  // namespace

TEST_P(ImplicitContact, AStaticProbeFeelsTheSameForceWhateverTheIntegratorAndTheSubstep) {
  Body body = boxBody({2, 2, 2}, kImplicitContactSpacing_m);
  body.material.mass_damping_per_s = 20;
  fixBottom(body);
  const Model model = modelOf({body});
  constexpr double kDepth_m = 1e-3, kRadius_m = 3e-3;
  // The middle of the top is pushed straight down.
  ReferenceSolver truth(model, Vector3d::Zero(), 1);
  const uint32_t pushed = slotOf(body, {1, 1, 2});
  solveStatics(truth, {{pushed, 0, 0}, {pushed, 1, 0}, {pushed, 2, -kDepth_m}});
  const double expected_n = reactions(truth)[pushed].z();
  ASSERT_LT(expected_n, 0);
  StylusConfig stylus;
  stylus.probe.radius_m = kRadius_m;
  for (const Variant& variant : variants()) {
    SCOPED_TRACE(::testing::Message() << "integrator " << static_cast<int>(variant.integrator) << " dt "
                                      << variant.fraction);
    const Scene scene = sceneWith(variant.integrator, model, 4, variant.fraction, kIterations, {stylus});
    const auto solver = make(model, scene);
    const Vector3d top(kImplicitContactSpacing_m, kImplicitContactSpacing_m,
                       2 * kImplicitContactSpacing_m - kDepth_m + kRadius_m);
    const double tick_s = 1 / scene.solver.tick_hz;
    for (double t = 0; t < 1.0; t += tick_s) solver->step(probeAt(top));
    const Vector3d force_n = xyz(lastStats(*solver).impulse[0]) / tick_s;
    EXPECT_NEAR(force_n.z(), expected_n, kImplicitContactForce * std::abs(expected_n));
    EXPECT_LT(std::hypot(force_n.x(), force_n.y()), kImplicitContactForce * std::abs(expected_n));
  }
}

TEST_P(ImplicitContact, AnObstacleBearsTheWeightOfWhatLiesOnItWhateverTheIntegratorAndTheSubstep) {
  Body body = boxBody({3, 3, 2}, kImplicitContactSpacing_m);
  body.material.mass_damping_per_s = 20;
  const Model model = modelOf({body});
  const Vector3d gravity(0, 0, -9.81);
  ReferenceSolver masses(model, gravity, 1);
  double weight_n = 0;
  for (const uint32_t slot : masses.active) weight_n += 9.81 * masses.mass(slot);
  for (const Variant& variant : variants()) {
    SCOPED_TRACE(::testing::Message() << "integrator " << static_cast<int>(variant.integrator) << " dt "
                                      << variant.fraction);
    Scene scene = sceneWith(variant.integrator, model, 4, variant.fraction, kIterations, {}, gravity);
    scene.obstacles = {planeAt(-1), planeAt(0)};
    const auto solver = make(model, scene);
    const double tick_s = 1 / scene.solver.tick_hz;
    for (double t = 0; t < 1.0; t += tick_s) solver->step({});
    const layout::TickStats stats = lastStats(*solver);
    const Vector3d borne = xyz(stats.obstacle_impulse[1]) / tick_s;
    EXPECT_NEAR(borne.z(), weight_n, kImplicitContactForce * weight_n);
    EXPECT_EQ(xyz(stats.obstacle_impulse[0]), Vector3d::Zero().eval());
    double lowest_m = 0;
    const HostState state = solver->readState();
    for (const uint32_t slot : masses.active) {
      lowest_m = std::min(lowest_m, masses.restPosition(slot).z() + state.displacement_m[slot].z);
    }
    EXPECT_GT(lowest_m, -1e-6);  // rounding
  }
}
