// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <random>

#include "solver/reference/reference_solver.h"
#include "support/lattices.h"

namespace viscera::test {

/// Returns a material of springs without drag and dashpot.
inline MaterialConfig undamped(double young_modulus_pa, double density_kg_per_m3, Weights weights) {
  MaterialConfig material;
  material.young_modulus_pa = young_modulus_pa;
  material.density_kg_per_m3 = density_kg_per_m3;
  material.mass_damping_per_s = material.stiffness_damping_ratio = 0;
  material.weights = weights;
  return material;
}

/// Returns a box of springs without drag and dashpot, k = h = 1 and a cell of 1 kg; exact in float32.
inline Body unitBody(const Vector3i& cells) {
  Body body = boxBody(cells, 1.0);
  body.material = undamped(2.5, 1, Weights::kCell);
  return body;
}

/// Returns the same with cells of the neo-Hookean law: mu = 1.
inline Body unitLawBody(const Vector3i& cells, double poisson_ratio) {
  Body body = ofLaw(unitBody(cells), poisson_ratio);
  body.material.young_modulus_pa = 2 * (1 + poisson_ratio);
  return body;
}

/// Returns a chain of unit masses and unit springs along z.
inline Body unitChain(int count) {
  Body body = chainBody(count, 1.0);
  body.material = unitBody({1, 1, 1}).material;
  return body;
}

inline uint32_t slotAt(const Body& body, int x, int y, int z) {
  return static_cast<uint32_t>(body.lattice.slotAt({x, y, z}));
}

/// Fixes the nodes at z = 0.
inline Body standing(Body body) {
  for (uint32_t slot : body.lattice.active_slots) {
    if (body.lattice.nodeAt(slot).z() == 0) body.lattice.nodes[slot].lo |= layout::kFixedBit;
  }
  return body;
}

inline Field randomField(const ReferenceLattice& lattice, double size, uint32_t seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(-size, size);
  Field out(lattice.slots(), Vector3d::Zero());
  for (uint32_t slot : lattice.active) out[slot] = Vector3d(uniform(random), uniform(random), uniform(random));
  return out;
}

/// Returns a body of two parts with cells that differ in all parameters; some cells are missing.
inline Body patchworkBody(Weights weights = Weights::kCell) {
  Solid solid;
  solid.spacing_m = 0.5;
  solid.cells = {3, 3, 2};
  solid.labels.assign(18, 1);
  for (size_t i = 0; i < 18; i += 2) solid.labels[i] = 2;
  solid.labels[4] = solid.labels[17] = 0;
  solid.part_names = {"soft", "hard"};
  Body body;
  body.name = "patchwork";
  body.lattice = buildLattice(solid, weights);
  body.material = undamped(2.5, 1, weights);
  body.parts = {{"hard", 40, 0.25, 3}};
  return body;
}

}  // namespace viscera::test
