// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include "model/body/network_builder.h"
#include "solver/reference/derivatives.h"
#include "solver/reference/reference_bodies.h"
#include "tools/motion_packing.h"

namespace viscera {
namespace {

using namespace test;

constexpr double kFloatStiffness = 2e-7;  ///< relative: stiffness and mass are float32 numbers

/// Returns a body of these nodes and springs, without drag and dashpot; every node of 1 kg.
Body linkedBody(const std::vector<Vector3d>& positions_m, const std::vector<NetworkSpring>& springs) {
  SpringNetwork network;
  network.positions_m = positions_m;
  network.masses_kg.assign(positions_m.size(), 1);
  network.springs = springs;
  Body body;
  body.name = "links";
  body.material = unitBody({1, 1, 1}).material;
  adoptNetwork(network, body);
  return body;
}

/// Returns five nodes with every kind of spring: at rest, stretched and compressed at rest, two between the same nodes,
/// one without rest length between separate nodes and one between coincident nodes.
Body oddBody() {
  const std::vector<Vector3d> at = {{0, 0, 0}, {1, 0.1, 0}, {0.3, 0.9, 0.2}, {0.5, 0.4, 1.1}, {0.5, 0.4, 1.1}};
  const auto length = [&](uint32_t a, uint32_t b) { return (at[b] - at[a]).norm(); };
  return linkedBody(at, {{0, 1, 2, length(0, 1)},
                         {0, 2, 1, 0.8 * length(0, 2)},
                         {0, 3, 0.5, 1.3 * length(0, 3)},
                         {1, 2, 3, length(1, 2)},
                         {1, 2, 0.25, length(1, 2)},
                         {1, 4, 1.5, 0},
                         {2, 3, 1, length(2, 3)},
                         {3, 4, 4, 0}});
}

uint32_t slotNear(const Body& body, const Vector3d& at) {
  uint32_t nearest = body.lattice.active_slots.front();
  for (uint32_t slot : body.lattice.active_slots) {
    if ((restPosition(body, slot) - at).norm() < (restPosition(body, nearest) - at).norm()) nearest = slot;
  }
  return nearest;
}

/// Returns a blade that points along -z from z = 2 and sweeps along y in the plane x = `x`, far beyond everything.
SubstepMotions sweepAt(float x, ToolMode mode = ToolMode::kCut) {
  SubstepMotions motions{};
  motions[0].from = {x, -5, 5, 0.1f};
  motions[0].to = {x, 5, 5, 1};
  motions[0].blade_from = {x, -5, -5, 0.05f};
  motions[0].blade_to = {x, 5, -5, 0};
  motions[0].orientation = {0, 0, 0, 1};
  motions[0].info = toolInfo(mode);
  return motions;
}

}  // namespace

TEST(ReferenceNetwork, ForcesAreTheSlopeOfTheEnergyAndHaveTheStiffnessMatrixForTheirs) {
  const Model model = modelOf({oddBody()});
  const ReferenceLattice lattice(model);
  for (uint32_t seed : {1u, 2u, 3u}) {
    const Field u = randomField(lattice, 0.3, seed);
    EXPECT_LT(forceError(lattice, u, 1.0), kAgreement);
    EXPECT_LT(stiffnessError(lattice, u, 1.0), kAgreement);
  }
}

TEST(ReferenceNetwork, PrestrainedSpringsPullAtRestAndTheOthersDoNot) {
  const Body body = linkedBody({{0, 0, 0}, {2, 0, 0}, {2, 3, 0}}, {{0, 1, 5, 1.5}, {1, 2, 7, 3}});
  const Model model = modelOf({body});
  const ReferenceLattice lattice(model);
  const Field forces = lattice.elasticForces(Field(model.slots(), Vector3d::Zero()));
  EXPECT_NEAR((forces[slotNear(body, {0, 0, 0})] - Vector3d(2.5, 0, 0)).norm(), 0, 1e-12);  // rounding
  EXPECT_NEAR((forces[slotNear(body, {2, 0, 0})] + Vector3d(2.5, 0, 0)).norm(), 0, 1e-12);
  EXPECT_EQ(forces[slotNear(body, {2, 3, 0})], Vector3d::Zero().eval());
}

TEST(ReferenceNetwork, SpringOfNoLengthIsHarmlessWhereItsEndsMeetAndPullsThemTogetherElsewhere) {
  const Body body = linkedBody({{1, 2, 3}, {1, 2, 3}}, {{0, 1, 4, 0}});
  const Model model = modelOf({body});
  const ReferenceLattice lattice(model);
  Field u(model.slots(), Vector3d::Zero());
  const uint32_t a = body.lattice.active_slots[0], b = body.lattice.active_slots[1];
  EXPECT_EQ(lattice.elasticForce(u, a), Vector3d::Zero().eval());
  EXPECT_EQ(lattice.strain(u, a, 0), 0);
  const Eigen::MatrixXd k = lattice.stiffnessMatrix(u);
  EXPECT_LT((k.block<3, 3>(0, 0) - 4 * Eigen::Matrix3d::Identity()).norm(), 1e-12);
  EXPECT_LT((k.block<3, 3>(0, 3) + 4 * Eigen::Matrix3d::Identity()).norm(), 1e-12);
  u[b] = Vector3d(0.3, 0, -0.4);
  EXPECT_LT((lattice.elasticForce(u, a) - 4 * u[b]).norm(), 1e-12);
  EXPECT_LT((lattice.elasticForce(u, b) + 4 * u[b]).norm(), 1e-12);
}

TEST(ReferenceNetwork, SpringThatIsCollapsedToAPointKeepsItsDirectionAtRest) {
  const Body body = linkedBody({{0, 0, 0}, {0, 2, 0}}, {{0, 1, 3, 2}});
  const Model model = modelOf({body});
  const ReferenceLattice lattice(model);
  Field u(model.slots(), Vector3d::Zero());
  const uint32_t low = slotNear(body, {0, 0, 0});
  u[low].y() = 2;
  EXPECT_LT((lattice.elasticForce(u, low) - Vector3d(0, -6, 0)).norm(),
            1e-12);  // 3 N/m times 2 m, in opposite directions
}

TEST(ReferenceNetwork, LatticeOfLinksIsTheImplicitOne) {
  for (const bool parts : {false, true}) {
    Body body = parts ? patchworkBody() : standing(unitBody({3, 2, 4}));
    body.material.stiffness_damping_ratio = 0.2;
    const Model implicit = modelOf({body});
    body.network = latticeNetwork(body);
    const Model links = modelOf({body});
    ReferenceLattice a(implicit), b(links);
    ASSERT_EQ(a.active, b.active);
    const Field u = randomField(a, 0.1, 4), v = randomField(a, 1, 5);
    const Field forces = a.elasticForces(u), of_links = b.elasticForces(u);
    const double scale = a.forceScale(u);
    for (uint32_t slot : a.active) {
      EXPECT_NEAR(b.mass(slot), a.mass(slot), kFloatStiffness * a.mass(slot));
      EXPECT_LT((of_links[slot] - forces[slot]).norm(), 10 * kFloatStiffness * scale) << slot;
      EXPECT_LT((b.dashpotForce(u, v, slot) - a.dashpotForce(u, v, slot)).norm(), 10 * kFloatStiffness * scale);
    }
    EXPECT_NEAR(b.elasticEnergy(u), a.elasticEnergy(u), kFloatStiffness * a.elasticEnergy(u));
    EXPECT_NEAR(b.dissipation(u, v), a.dissipation(u, v), kFloatStiffness * a.dissipation(u, v));
    const Eigen::MatrixXd k = a.stiffnessMatrix(u), of_links_k = b.stiffnessMatrix(u);
    EXPECT_LT((of_links_k - k).cwiseAbs().maxCoeff(), kFloatStiffness * k.cwiseAbs().maxCoeff());
  }
}

TEST(ReferenceNetwork, CutLatticeOfLinksLosesTheSpringsAndCellsOfTheImplicitOne) {
  Body body = unitBody({3, 3, 3});
  const Model implicit = modelOf({body});
  body.network = latticeNetwork(body);
  const Model links = modelOf({body});
  ReferenceSolver a(implicit, Vector3d::Zero(), 1e-3), b(links, Vector3d::Zero(), 1e-3);
  for (const ToolMode mode : {ToolMode::kCut, ToolMode::kCutParticles}) {
    const float at = mode == ToolMode::kCut ? 0.6f : 3.0f;
    a.substep(sweepAt(at, mode));
    b.substep(sweepAt(at, mode));
    EXPECT_GT(a.springs_cut, 0u);
    EXPECT_EQ(a.springs_cut, b.springs_cut);
    for (uint32_t slot : a.active) {
      EXPECT_EQ(a.nodes[slot].lo, b.nodes[slot].lo) << slot;
      EXPECT_EQ(a.nodes[slot].hi, b.nodes[slot].hi) << slot;
    }
    const Field u = randomField(a, 0.1, 4);
    for (uint32_t slot : a.active) {
      EXPECT_LT((a.elasticForce(u, slot) - b.elasticForce(u, slot)).norm(), 10 * kFloatStiffness * a.forceScale(u));
    }
  }
}

TEST(ReferenceNetwork, CutTakesASpringFromBothEndsAndSaysWhere) {
  const Body body = linkedBody({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 5, 1}, {0, 1, 2, 1}, {0, 2, 1, 1}});
  const Model model = modelOf({body});
  ReferenceSolver solver(model, Vector3d::Zero(), 1e-3);
  const uint32_t origin = slotNear(body, {0, 0, 0}), right = slotNear(body, {1, 0, 0}),
                 left = slotNear(body, {0, 1, 0});
  const double mass = solver.mass(origin);
  solver.substep(sweepAt(0.25f));
  EXPECT_EQ(solver.springs_cut, 2u);
  EXPECT_EQ(solver.mass(origin), mass);
  EXPECT_EQ(solver.nodes[origin].lo & layout::kValenceMask, 1u);
  EXPECT_EQ(solver.nodes[right].lo & layout::kValenceMask, 0u);
  EXPECT_TRUE(solver.isIsolated(right));
  EXPECT_FALSE(solver.isIsolated(left));
  size_t cut = 0;
  for (float fraction : solver.state().spring_cut) {
    if (fraction == 0) continue;
    ++cut;
    EXPECT_NEAR(fraction, origin < right ? 0.25 : 0.75, 1e-6);  // float32
  }
  EXPECT_EQ(cut, 2u);
  solver.u_m[right].x() = 1;
  EXPECT_EQ(solver.force(origin), Vector3d::Zero().eval());
  EXPECT_EQ(solver.force(right), Vector3d::Zero().eval());
  solver.substep(sweepAt(0.25f));
  EXPECT_EQ(solver.springs_cut, 2u) << "what is cut is not cut again";
}

TEST(ReferenceNetwork, EveryIntegratorMovesItAlikeInShortSubsteps) {
  const Model model = modelOf({oddBody()});
  constexpr int kSubsteps = 2000;
  constexpr double kTime_s = 0.5;
  Field ends[3];
  for (ReferenceIntegrator integrator :
       {ReferenceIntegrator::kLeapfrog, ReferenceIntegrator::kVerletPaper, ReferenceIntegrator::kImplicitEuler}) {
    ReferenceOptions options;
    options.integrator = integrator;
    ReferenceSolver solver(model, Vector3d(0, 0, -1), kTime_s / kSubsteps, options);
    for (int i = 0; i < kSubsteps; ++i) solver.substep();
    ends[static_cast<int>(integrator)] = solver.u_m;
  }
  for (uint32_t slot : model.bodies[0].lattice.active_slots) {
    // dt = T / 2000: verlet_paper starts half a kick ahead, implicit Euler is of first order.
    EXPECT_LT((ends[1][slot] - ends[0][slot]).norm(), 2e-3);
    EXPECT_LT((ends[2][slot] - ends[0][slot]).norm(), 2e-3);
  }
}

TEST(ReferenceNetwork, BodiesAreNumberedOneBehindTheOther) {
  Body lattice = unitBody({1, 1, 1}), first = linkedBody({{0, 0, 0}, {1, 0, 0}}, {{0, 1, 5, 1}}),
       second = linkedBody({{0, 0, 0}, {0, 2, 0}, {2, 0, 0}}, {{0, 1, 3, 2}, {0, 2, 7, 2}});
  const Model model = modelOf({first, lattice, second});
  ReferenceLattice all(model);
  EXPECT_EQ(all.spring_cut.size(), 3u);
  const uint32_t offset = model.slotOffset(2);
  const uint32_t origin = offset + slotNear(second, {0, 0, 0}), right = offset + slotNear(second, {2, 0, 0});
  ASSERT_EQ(all.springsOf(right), 1u);
  EXPECT_EQ(all.farEnd(right, 0), origin);
  EXPECT_EQ(all.stiffness(right, 0), 7);
  EXPECT_EQ(all.springsOf(model.slotOffset(1)), layout::kSpringsPerNode);
  Field u(model.slots(), Vector3d::Zero());
  u[right].x() = 1;
  EXPECT_LT((all.elasticForce(u, origin) - Vector3d(7, 0, 0)).norm(), 1e-12);
  all.eraseSpring(right, 0, 0.3);
  EXPECT_EQ(all.elasticForce(u, origin), Vector3d::Zero().eval());
  EXPECT_EQ(all.spring_cut[0], 0);
}

}  // namespace viscera
