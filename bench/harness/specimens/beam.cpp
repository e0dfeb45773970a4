// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "bench/harness/specimens/beam.h"

#include <algorithm>

#include "solver/reference/statics.h"

namespace viscera::bench {

namespace {

constexpr int kInverseIterations = 8;  ///< bending modes of a beam are 40 : 1 apart in omega^2
constexpr int kLoadSteps = 4;

}  // namespace

Model beamModel(const Vector3i& cells, const MaterialConfig& material) {
  return blockModel(cells, kBeamSpacing_m, material, [](const Vector3i& node) { return node.z() == 0; });
}

/// Uses inverse iteration: u <- K^-1 M u.
Field lowestMode(const Model& model, double largest_m) {
  const ReferenceSolver solver(model, Vector3d::Zero(), 1);
  Field mode(model.slots(), Vector3d::UnitX());
  for (int i = 0; i < kInverseIterations; ++i) {
    Field inertia(model.slots(), Vector3d::Zero());
    for (uint32_t slot : solver.active) inertia[slot] = solver.mass(slot) * mode[slot];
    mode = solveLinear(solver, {}, inertia);
    const double scale = largest_m / largestNorm(mode);
    for (Vector3d& u : mode) u *= scale;
  }
  return mode;
}

Field bent(const Model& model, double largest_m) {
  ReferenceSolver solver(model, Vector3d::Zero(), 1);
  StaticsOptions options;
  options.load_steps = kLoadSteps;
  solveStatics(solver, {}, linearReactions(solver, lowestMode(model, largest_m)), options);
  return solver.u_m;
}

Field sag(const Model& model, const Vector3d& gravity_m_per_s2) {
  ReferenceSolver solver(model, gravity_m_per_s2, 1);
  StaticsOptions options;
  options.load_steps = kLoadSteps;
  solveStatics(solver, {}, {}, options);
  return solver.u_m;
}

}  // namespace viscera::bench
