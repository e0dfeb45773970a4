// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "solver/processes/node_masses.h"

#include "viscera/model/body/elasticity.h"

namespace viscera {

NodeMasses::NodeMasses(const Model& model) : kg(model.slots(), 0), inverse_per_kg(model.slots(), 0) {
  for (uint32_t b = 0; b < model.bodies.size(); ++b) {
    const Body& body = model.bodies[b];
    const bool has_cells = body.hasCells();
    const std::vector<float> of_cells_kg = has_cells ? strengths(body).mass_kg : std::vector<float>();
    for (const uint32_t slot : body.lattice.active_slots) {
      const double mass_kg = has_cells ? static_cast<double>(of_cells_kg[slot]) : body.network->masses_kg[slot];
      if (!(mass_kg > 0) || isFixed(body.lattice.nodes[slot])) continue;
      kg[model.slotOffset(b) + slot] = static_cast<float>(mass_kg);
      inverse_per_kg[model.slotOffset(b) + slot] = static_cast<float>(1 / mass_kg);
    }
  }
}

}  // namespace viscera
