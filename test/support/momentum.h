// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "support/gpu_fixture.h"

namespace viscera::test {

/// Returns the momentum of all nodes [N s], with the masses of the float64 reference.
inline Vector3d momentum(const Model& model, const HostState& state) {
  ReferenceSolver reference(model, Vector3d::Zero(), 1);
  load(reference, state);
  Vector3d sum = Vector3d::Zero();
  for (const uint32_t slot : reference.active) sum += reference.mass(slot) * reference.v_m_per_s[slot];
  return sum;
}

}  // namespace viscera::test
