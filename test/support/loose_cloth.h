// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "support/gpu_fixture.h"
#include "support/networks.h"

namespace viscera::test {

/// Returns a cloth without damping.
inline Body looseCloth(int rows, int columns, double spacing_m) {
  Body body = clothBody(rows, columns, spacing_m);
  body.material.mass_damping_per_s = body.material.stiffness_damping_ratio = 0;
  return body;
}

/// Places a body: its nodes move from rest to pose * rest, all with one velocity.
inline void place(const Model& model, size_t body, const Pose& pose, const Vector3d& velocity_m_per_s,
                  HostState& state) {
  const uint32_t first = model.slotOffset(body);
  for (const uint32_t slot : model.bodies[body].lattice.active_slots) {
    const Vector3d rest = restPosition(model.bodies[body], slot);
    state.displacement_m[first + slot] = vec4(pose * rest - rest);
    state.velocity_m_per_s[first + slot] = vec4(velocity_m_per_s);
  }
}

inline Vector3d positionOf(const Model& model, size_t body, uint32_t slot, const HostState& state) {
  return restPosition(model.bodies[body], slot) + xyz(state.displacement_m[model.slotOffset(body) + slot]);
}

/// Calls visit(position [m], velocity [m/s]) for the nodes of a body.
template <class Visit>
void forEachNode(const Model& model, size_t body, const HostState& state, Visit visit) {
  for (const uint32_t slot : model.bodies[body].lattice.active_slots) {
    visit(positionOf(model, body, slot, state), xyz(state.velocity_m_per_s[model.slotOffset(body) + slot]));
  }
}

}  // namespace viscera::test
