// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "solver/multigrid/step_rules.h"

#include "viscera/math/error.h"

namespace viscera::multigrid {

void requireSteppable(const Model& model, bool node_contacts) {
  if (model.hasNetwork())
    throw SceneError(
        "solver.integrator: multigrid steps implicit lattices, not bodies with explicit connections: use leapfrog, vbd "
        "or pd");
  if (node_contacts)
    throw SceneError(
        "solver.integrator: multigrid knows no contacts between nodes (collision.enabled): use leapfrog, vbd or pd");
}

}  // namespace viscera::multigrid
