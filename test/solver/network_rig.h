// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "support/backends.h"
#include "support/implicit.h"
#include "support/networks.h"
#include "viscera/model/scene/scene.h"

namespace viscera::test {

/// Returns a state with the nodes of all bodies displaced and moving at random, except fixed ones.
inline HostState scatteredState(const Model& model, double size_m, double speed_m_per_s, uint32_t seed) {
  std::mt19937 random(seed);
  HostState state = restState(model);
  for (size_t b = 0; b < model.bodies.size(); ++b) {
    for (uint32_t slot : model.bodies[b].lattice.active_slots) {
      const Vector3d u = randomVector(random, size_m), v = randomVector(random, speed_m_per_s);
      if (isFixed(model.bodies[b].lattice.nodes[slot])) continue;
      state.displacement_m[model.slotOffset(b) + slot] = vec4(u);
      state.velocity_m_per_s[model.slotOffset(b) + slot] = vec4(v);
    }
  }
  return state;
}

inline Body undamped(Body body) {
  body.material.mass_damping_per_s = body.material.stiffness_damping_ratio = 0;
  return body;
}

/// Returns the body with the springs of its lattice as explicit connections (VR05 2.5.1).
inline Body withLinks(Body body, double bending_ratio = 0) {
  body.network = latticeNetwork(body, bending_ratio);
  return body;
}

/// Returns a lattice, a cloth, a graph and a lattice of links that differ in all parameters.
inline Model mixedModel() {
  const Body box = boxBody({4, 3, 5}, 0.01);
  Body links = withLinks(box);
  links.material.mass_damping_per_s = 20;
  GraphOptions options;
  options.prestrain = 0.05;
  options.fixed_share = 0.1;
  return modelOf({box, clothBody(9, 8, 0.01), graphBody(130, 400, 5, options), links});
}

/// Returns the forces [N] on every node in a state at rest, from the velocity after leapfrog's first half kick; without
/// drag and gravity.
inline std::vector<Vector3d> forcesOf(const std::string& backend, const Model& model, const HostState& state) {
  const auto solver = makeBackend(backend, model, sceneFor(model, 1));
  solver->writeState(state);
  solver->step({});
  const HostState after = solver->readState();
  const ReferenceLattice lattice(model);
  std::vector<Vector3d> out(model.slots(), Vector3d::Zero());
  for (uint32_t slot : lattice.active) {
    out[slot] = lattice.mass(slot) * xyz(after.velocity_m_per_s[slot]) / (0.5 * solver->dt_s());
  }
  return out;
}

/// Returns the largest difference over the largest force.
inline double forceDifference(const std::vector<Vector3d>& a, const std::vector<Vector3d>& b) {
  double difference = 0, largest = 0;
  for (size_t slot = 0; slot < a.size(); ++slot) {
    difference = std::max(difference, (a[slot] - b[slot]).norm());
    largest = std::max(largest, b[slot].norm());
  }
  return largest > 0 ? difference / largest : difference;
}

/// Returns the reference's forces on nodes that may move, zero on the others.
inline std::vector<Vector3d> trueForces(const Model& model, const HostState& state) {
  ReferenceSolver reference(model, Vector3d::Zero(), 1);
  load(reference, state);
  std::vector<Vector3d> out = reference.elasticForces(reference.u_m);
  for (uint32_t slot : reference.active) {
    if (isFixed(reference.nodes[slot])) out[slot].setZero();
  }
  return out;
}

}  // namespace viscera::test
