// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "support/gpu_fixture.h"

namespace viscera::test {

/// Returns a state with all nodes of the first body displaced and moving at random.
inline HostState randomState(const Model& model, double size_m, double speed_m_per_s, uint32_t seed) {
  std::mt19937 random(seed);
  HostState state = restState(model);
  for (uint32_t slot : model.bodies[0].lattice.active_slots) {
    state.displacement_m[slot] = vec4(randomVector(random, size_m));
    state.velocity_m_per_s[slot] = vec4(randomVector(random, speed_m_per_s));
  }
  return state;
}

/// Returns the same as sceneFor, for an integrator other than leapfrog. @param fraction  substep over dt_safe
inline Scene sceneWith(Integrator integrator, const Model& model, int substeps, double fraction, int iterations = 20,
                       std::vector<StylusConfig> styluses = {}, const Vector3d& gravity = Vector3d::Zero()) {
  Scene scene = sceneFor(model, substeps, std::move(styluses), gravity);
  scene.solver.tick_hz *= 0.5 / fraction;
  scene.solver.substeps = substeps;
  scene.solver.integrator = integrator;
  scene.solver.iterations = iterations;
  return scene;
}

inline ReferenceSolver referenceFor(ReferenceIntegrator integrator, const Model& model, const Solver& solver,
                                    const HostState& start, const Vector3d& gravity = Vector3d::Zero()) {
  ReferenceOptions options;
  options.integrator = integrator;
  ReferenceSolver reference(model, gravity, static_cast<float>(solver.dt_s()), options);
  load(reference, start);
  return reference;
}

/// Returns the kinetic and elastic energy [J] in float64; not finite if any number is not.
inline double energyOf(const Model& model, const HostState& state) {
  ReferenceSolver reference(model, Vector3d::Zero(), 1);
  load(reference, state);
  return reference.kineticEnergy() + reference.elasticEnergy();
}

}  // namespace viscera::test
