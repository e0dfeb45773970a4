// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
// Blocks that are fixed at one face.
#pragma once

#include <optional>

#include "solver/make_solver.h"
#include "support/implicit.h"

namespace viscera::test {

inline const Vector3d kGravity(0, 0, -9.81);

/// Returns a block of 10 cm, fixed at one face; of springs, or of the neo-Hookean law if a Poisson's ratio is given.
inline Body block(int cells, double young_modulus_pa, std::optional<double> nu = {}) {
  Body body = boxBody(Vector3i::Constant(cells), 0.1 / cells);
  if (nu) body = ofLaw(body, *nu);
  body.material.young_modulus_pa = young_modulus_pa;
  body.material.density_kg_per_m3 = 1060;
  body.material.mass_damping_per_s = 0;
  body.material.stiffness_damping_ratio = 0;
  for (const uint32_t slot : body.lattice.active_slots) {
    if (body.lattice.nodeAt(slot).x() == 0) body.lattice.nodes[slot].lo |= layout::kFixedBit;
  }
  return body;
}

inline Scene sceneOf(Integrator integrator, std::vector<StylusConfig> styluses = {}) {
  Scene scene;
  scene.styluses = std::move(styluses);
  scene.environment.gravity_m_per_s2 = kGravity;
  scene.solver.integrator = integrator;
  scene.solver.stability_monitor = false;
  scene.solver.sleep_speed_m_per_s = 0;
  return scene;
}

inline double lowest(const Model& model, const HostState& state) {
  double out = 0;
  for (const uint32_t slot : model.bodies[0].lattice.active_slots)
    out = std::min(out, xyz(state.displacement_m[slot]).z());
  return out;
}

inline double largestOff(const Model& model, const HostState& a, const HostState& b) {
  double out = 0;
  for (const uint32_t slot : model.bodies[0].lattice.active_slots)
    out = std::max(out, (xyz(a.displacement_m[slot]) - xyz(b.displacement_m[slot])).norm());
  return out;
}

}  // namespace viscera::test
