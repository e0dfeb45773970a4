// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
// The finest level of multigrid against the float64 reference, and the levels below it.
#include <gtest/gtest.h>

#include "solver/multigrid/steps/stage_solver.h"
#include "solver/reference/reference_solver.h"
#include "support/lattices.h"
#include "support/random_state.h"

namespace viscera::test {

namespace {

using multigrid::FineLevel;
using multigrid::Vectors;

constexpr double kFloat = 3e-6;  // relative: sums of some hundred float32 terms, 6e-8 each
constexpr double kShort =
    8e-3;  // relative: tangents of springs are upper halves of floats, s to 2^-9 and so s s^T to 2^-8; twice that

/// A box that is held at its low x end. @param nu  Poisson's ratio
Body heldBox(const Vector3i& cells, double nu, Cells kind = Cells::kSprings) {
  Body body =
      kind == Cells::kSprings ? boxBody(cells, 0.01) : momentBody(cells, 0.01, [](const Vector3d&) { return true; });
  body.material.cells = kind;
  body.material.poisson_ratio = nu;
  body.material.dashpot_ratio = 0;
  for (const uint32_t slot : body.lattice.active_slots) {
    if (body.lattice.nodeAt(slot).x() == 0) body.lattice.nodes[slot].lo |= layout::kFixedBit;
  }
  return body;
}

/// Springs alone, with volumes, by moments, partly filled cells by moments.
std::vector<Body> bodies() {
  std::vector<Body> out = {heldBox({3, 4, 5}, 0.25),
                           heldBox({3, 4, 5}, 0.45),
                           heldBox({3, 4, 5}, 0.1),
                           heldBox({3, 4, 5}, 0.25, Cells::kMoments),
                           heldBox({3, 4, 5}, 0.45, Cells::kMoments),
                           thinBody(1.2, 0.01),
                           askewBody(0.01),
                           askewBody(0.01)};
  out.back().material.poisson_ratio = 0.45;
  for (Body& body : out) body.material.dashpot_ratio = 0;
  return out;
}

/// A level of a model, with its lattice.
struct Rig {
  explicit Rig(Body body)
      : model(modelOf({std::move(body)})),
        lattice(model, bodyParams(model, safeTimeStep(model)), featuresOf(model, Scene(), 1)),
        solver(model, lattice, serial),
        n(solver.level.places()) {}
  Vectors vectors(const Field& field) const {
    Vectors out(3 * n);
    const multigrid::Grid& grid = solver.level.grid();
    for (uint32_t node = 0; node < grid.nodeCount(); ++node) {
      for (size_t c = 0; c < 3; ++c)
        out[c * n + grid.place_of[node]] = static_cast<float>(field[grid.slots[node]][static_cast<int>(c)]);
    }
    return out;
  }
  Field field(const Vectors& vectors) const {
    Field out(model.slots(), Vector3d::Zero());
    const multigrid::Grid& grid = solver.level.grid();
    for (uint32_t node = 0; node < grid.nodeCount(); ++node) {
      const size_t at = grid.place_of[node];
      out[grid.slots[node]] = Vector3d(vectors[at], vectors[n + at], vectors[2 * n + at]);
    }
    return out;
  }
  Field randomField(double size, uint32_t seed, bool free_only) const {
    std::mt19937 random(seed);
    Field out(model.slots(), Vector3d::Zero());
    for (const uint32_t slot : model.bodies[0].lattice.active_slots) {
      const Vector3d value = randomVector(random, size);
      if (!free_only || !isFixed(model.bodies[0].lattice.nodes[slot])) out[slot] = value;
    }
    return out;
  }

  Model model;
  CpuLattice lattice;
  Serial serial;
  multigrid::StageSolver solver;
  size_t n;
};

double largest(const Field& field) {
  double out = 0;
  for (const Vector3d& each : field) out = std::max(out, each.norm());
  return out;
}

double largestDifference(const Field& a, const Field& b) {
  double out = 0;
  for (size_t i = 0; i < a.size(); ++i) out = std::max(out, (a[i] - b[i]).norm());
  return out;
}

}  // namespace

TEST(MultigridLevel, ForcesAndEnergyAreThoseOfTheReference) {
  for (const Body& body : bodies()) {
    Rig rig(body);
    const ReferenceLattice reference(rig.model);
    const Field u = rig.randomField(0.001, 3, false);
    const Vectors at = rig.vectors(u), still(3 * rig.n);
    const double energy_j = rig.solver.level.linearise(at, still);
    const Field truth = reference.elasticForces(u), found = rig.field(rig.solver.level.force());
    EXPECT_LT(largestDifference(found, truth), kFloat * largest(truth) * 3);
    EXPECT_NEAR(energy_j, reference.elasticEnergy(u), kFloat * reference.springEnergy(u) * 3);
  }
}

TEST(MultigridLevel, ProductIsTheChangeOfForcesAtRest) {
  constexpr double kStep = 1e-6;  // m: forces are linear over it to 1e-4, its square is taken out
  for (const Body& body : bodies()) {
    Rig rig(body);
    const ReferenceLattice reference(rig.model);
    const Field direction = rig.randomField(1, 5, true);
    Field ahead = direction, behind = direction;
    for (Vector3d& each : ahead) each *= kStep;
    for (Vector3d& each : behind) each *= -kStep;
    const Field up = reference.elasticForces(ahead), down = reference.elasticForces(behind);
    const Vectors rest(3 * rig.n), x = rig.vectors(direction);
    Vectors y(3 * rig.n);
    rig.solver.level.begin({});
    rig.solver.level.linearise(rest, rest);
    rig.solver.level.apply(x, y);
    const Field found = rig.field(y);
    double off = 0, size = 0;
    for (const uint32_t slot : rig.model.bodies[0].lattice.active_slots) {
      if (isFixed(rig.model.bodies[0].lattice.nodes[slot])) {
        EXPECT_EQ(found[slot], Vector3d::Zero());
        continue;
      }
      const Vector3d truth = (down[slot] - up[slot]) / (2 * kStep);
      off = std::max(off, (found[slot] - truth).norm());
      size = std::max(size, truth.norm());
    }
    EXPECT_LT(off, kShort * size);
  }
}

TEST(MultigridLevel, ProductIsSymmetricAndPositiveInStrainedStates) {
  for (const Body& body : bodies()) {
    Rig rig(body);
    const Vectors u = rig.vectors(rig.randomField(0.0015, 8, true)), still(3 * rig.n);
    rig.solver.level.begin({});
    rig.solver.level.linearise(u, still);
    const Vectors x = rig.vectors(rig.randomField(1, 9, true)), y = rig.vectors(rig.randomField(1, 10, true));
    Vectors ax(3 * rig.n), ay(3 * rig.n);
    rig.solver.level.apply(x, ax);
    rig.solver.level.apply(y, ay);
    const double xay = rig.solver.level.dot(x, ay), yax = rig.solver.level.dot(y, ax),
                 xax = rig.solver.level.dot(x, ax);
    EXPECT_GT(xax, 0);
    EXPECT_NEAR(xay, yax, kFloat * xax * 3);
  }
}

TEST(MultigridLevel, CoarseLevelsAreGalerkins) {
  std::vector<Body> all = bodies();
  all.push_back(heldBox({8, 8, 8}, 0.45, Cells::kMoments));
  slit(all.back(), 0, 3, 2);
  for (const Body& body : all) {
    Rig rig(body);
    rig.solver.begin({1e4, 100});  // of the order of springs' own rates, so that masses count
    const multigrid::Hierarchy& hierarchy = *rig.solver.hierarchy();
    const multigrid::CoarseLevel& coarse = hierarchy.coarse(0);
    const multigrid::Transfer& t = hierarchy.transfer(0);
    multigrid::Quads x(coarse.numbers()), y(coarse.numbers());
    std::mt19937 random(4);
    for (size_t i = 0; i < x.size(); ++i) x[i] = i % 4 == 3 ? 0 : static_cast<float>(randomVector(random, 1).x());
    coarse.apply(rig.serial, x, y);
    Vectors fine(3 * rig.n), product(3 * rig.n);
    const multigrid::Grid& grid = rig.solver.level.grid();
    for (uint32_t node = 0; node < grid.nodeCount(); ++node)
      for (uint32_t i = t.starts[node]; i < t.starts[node + 1]; ++i)
        for (size_t c = 0; c < 3; ++c) fine[c * rig.n + grid.place_of[node]] += t.weights[i] * x[4 * t.parents[i] + c];
    rig.solver.level.apply(fine, product);
    double off = 0, size = 0;
    for (size_t node = 0; node < coarse.nodes(); ++node) {
      for (size_t c = 0; c < 3; ++c) {
        double sum = 0;
        for (uint32_t i = t.coarse_starts[node]; i < t.coarse_starts[node + 1]; ++i)
          sum += static_cast<double>(t.coarse_weights[i] * product[c * rig.n + grid.place_of[t.children[i]]]);
        off = std::max(off, std::abs(sum - static_cast<double>(y[4 * node + c])));
        size = std::max(size, std::abs(sum));
      }
    }
    EXPECT_LT(off, kShort * size);
  }
}

TEST(MultigridLevel, SidesOfACutAreNotMergedAndEveryNodeIsReached) {
  Body cut = heldBox({8, 8, 8}, 0.25);
  slit(cut, 0, 3, 0);  // all the way through
  Rig whole(heldBox({8, 8, 8}, 0.25)), rig(cut);
  for (Rig* each : {&whole, &rig}) each->solver.begin({1e4, 100});
  // 8 cells along x are 4 coarse ones, 5 layers of nodes; the nodes on both sides of the cut take from the third, which
  // becomes two.
  EXPECT_EQ(whole.solver.hierarchy()->coarse(0).nodes(), 5u * 25);
  EXPECT_EQ(rig.solver.hierarchy()->coarse(0).nodes(), 6u * 25);
  const multigrid::Transfer& t = rig.solver.hierarchy()->transfer(0);
  const multigrid::Grid& grid = rig.solver.level.grid();
  for (uint32_t node = 0; node < grid.nodeCount(); ++node) {
    float sum = 0;
    for (uint32_t i = t.starts[node]; i < t.starts[node + 1]; ++i) sum += t.weights[i];
    EXPECT_EQ(sum, rig.solver.level.free()[grid.place_of[node]]);
  }
}

TEST(MultigridLevel, CoarseLevelsKnowACutUpToItsFront) {
  // Cut at x between nodes 3 and 4, from y = 3 or 4 on: of the places at x = 4, those at y = 4, 6, 8 have two nodes on
  // the first coarse level. Merging by cells closes the cut up to y = 4.
  for (const int first : {3, 4}) {
    Body cut = heldBox({8, 8, 8}, 0.25);
    slit(cut, 0, 3, first);
    Rig rig(cut);
    rig.solver.begin({1e4, 100});
    EXPECT_EQ(rig.solver.hierarchy()->coarse(0).nodes(), 5u * 25 + 3 * 5) << "front before y = " << first;
  }
}

}  // namespace viscera::test
