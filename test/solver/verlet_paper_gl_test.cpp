// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "support/random_state.h"
#include "support/solver_rig.h"

using namespace viscera;
using namespace viscera::test;

namespace {

constexpr int kVerletPaperSubsteps = 10;
// A rounding of a position is up to 2^-24 of it. A substep makes about four: of 2 x, - x_prev, + dt^2 a, and those of
// the neighbours that return as forces. x+ = 2 x - x_prev carries each on as a velocity: over n substeps n (n + 1)/2 of
// them at worst.
constexpr double kVerletPaperRounding = 1.0 / (1 << 24);
constexpr double kVerletPaperRoundingsPerSubstep = 4;

class VerletPaper : public OnBackend {
 protected:
  /// Returns the largest error against float64 after kSubsteps [m].
  double expectLikeReference(const Model& model, const Vector3d& gravity) {
    const auto solver =
        make(model, sceneWith(Integrator::kVerletPaper, model, kVerletPaperSubsteps, 0.5, 1, {}, gravity));
    const HostState start = randomState(model, 0.05 * model.bodies[0].lattice.spacing_m, 0.1, 7);
    solver->writeState(start);
    ReferenceSolver reference = referenceFor(ReferenceIntegrator::kVerletPaper, model, *solver, start, gravity);
    solver->step({});
    for (int s = 0; s < kVerletPaperSubsteps; ++s) reference.substep();
    return expectPositionsRounded(solver->readState(), reference, kVerletPaperRoundingsPerSubstep, kVerletPaperSubsteps,
                                  solver->dt_s());
  }
};

INSTANTIATE_TEST_SUITE_P(Backends, VerletPaper, ::testing::ValuesIn(backendKinds()), backendSuffix);

}  // namespace

TEST_P(VerletPaper, MatchesReferenceAtEverySize) {
  for (size_t size : kSizes) {
    SCOPED_TRACE(size);
    Body body = blobBody(size, 0.01, 3);
    body.material.mass_damping_per_s = 50;
    expectLikeReference(modelOf({body}), Vector3d(0.3, -0.2, -9.81));
  }
}

TEST_P(VerletPaper, MatchesReferenceWithParts) {
  Body body = boxBody({5, 4, 6}, 0.01);
  expectLikeReference(modelOf({body}), Vector3d(0, 0, -9.81));
  body.parts = {{"box", 60e3, 0.25, 2000}};
  expectLikeReference(modelOf({body}), Vector3d(0, 0, -9.81));
}

TEST_P(VerletPaper, PaysForItsAbsolutePositions) {
  Body here = boxBody({5, 5, 5}, 0.01), far = here;
  far.lattice.origin_m = Vector3d(1, 1, 1);
  const double near_error_m = expectLikeReference(modelOf({here}), Vector3d::Zero());
  const double far_error_m = expectLikeReference(modelOf({far}), Vector3d::Zero());
  EXPECT_GT(far_error_m, 5 * near_error_m);  // positions 20 times as large
}

TEST_P(VerletPaper, DashpotsAreUnknownToIt) {
  Body body = boxBody({4, 4, 4}, 0.01);
  const auto hash = [&](double stiffness_damping_ratio) {
    body.material.stiffness_damping_ratio = stiffness_damping_ratio;
    const Model model = modelOf({body});
    const auto solver = make(model, sceneWith(Integrator::kVerletPaper, model, kVerletPaperSubsteps, 0.5));
    solver->writeState(randomState(model, 1e-3, 0.5, 11));
    solver->step({});
    return stateHash(model, solver->readState());
  };
  EXPECT_EQ(hash(0.2), hash(0));
}

/// A released node's speed is clamped: it must continue from that, not from the old x_prev.
TEST_P(VerletPaper, GrabbedNodesFollowTheToolAndAreLetGoAtTheReleaseSpeed) {
  const Model model = modelOf({boxBody({4, 4, 4}, 0.01)});
  StylusConfig config;
  config.grab.radius_m = 0.005;
  config.grab.release_speed_m_per_s = 0.01;
  const auto solver = make(model, sceneWith(Integrator::kVerletPaper, model, 1, 0.1, 1, {config}));
  const uint32_t corner = static_cast<uint32_t>(model.bodies[0].lattice.slotAt({0, 0, 0}));
  const double offset_m = 0.5 * solver->dt_s();  // half a metre per second
  ToolMotions motions;
  for (int t = 0; t < 3; ++t) {
    motions = tool(ToolMode::kGrab, {-t * offset_m, 0, 0}, {-(t + 1) * offset_m, 0, 0});
    motions[0].hold_begins = t == 0;
    solver->step(motions);
    motions[0].hold_begins = false;
    // At most 0.01 m of spacing and of grab offset, rounded a few times.
    EXPECT_NEAR(solver->readState().displacement_m[corner].x, -(t + 1) * offset_m, 4 * kVerletPaperRounding * 0.01);
  }
  motions[0].mode = ToolMode::kNone;
  motions[0].hold_ended = ToolMode::kGrab;
  solver->step(motions);
  // The springs pull it back, so it moves by less than the release speed times the substep.
  const double moved_m = -3 * offset_m - solver->readState().displacement_m[corner].x;
  EXPECT_LT(moved_m, config.grab.release_speed_m_per_s * solver->dt_s());
}

TEST_P(VerletPaper, GoesOnFromAStateThatWasSaved) {
  const Model model = modelOf({boxBody({4, 4, 4}, 0.01)});
  const Scene scene = sceneWith(Integrator::kVerletPaper, model, kVerletPaperSubsteps, 0.5);
  const auto saved = make(model, scene), loaded = make(model, scene);
  saved->writeState(randomState(model, 5e-4, 0.1, 7));
  saved->step({});
  loaded->step({});
  loaded->writeState(saved->readState(), true);
  saved->step({});
  loaded->step({});
  const HostState a = saved->readState(), b = loaded->readState();
  // x is rounded once more by the conversion to u and back: like one more substep's roundings.
  const double rounding_m = kVerletPaperRoundingsPerSubstep * kVerletPaperRounding * 0.04;
  for (uint32_t slot : model.bodies[0].lattice.active_slots) {
    EXPECT_LT((xyz(a.displacement_m[slot]) - xyz(b.displacement_m[slot])).norm(), rounding_m * kVerletPaperSubsteps);
  }
}
