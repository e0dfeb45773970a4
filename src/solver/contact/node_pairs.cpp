// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "solver/contact/node_pairs.h"

#include "model/scene/integrators.h"
#include "viscera/model/scene/scene.h"

namespace viscera {

bool solvesContacts(const Scene& scene) {
  return scene.collision.enabled && !traitsOf(scene.solver.integrator).is_explicit;
}

}  // namespace viscera
