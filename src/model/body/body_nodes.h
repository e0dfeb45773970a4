// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>

#include "viscera/model/model.h"

namespace viscera {

/// Calls visit(slot) for each node of a body that has mass, in ascending order.
template <class Visit>
void forEachNode(const Body& body, const Visit& visit) {
  if (!body.network) {
    for (const uint32_t slot : body.lattice.active_slots) visit(slot);
    return;
  }
  for (uint32_t slot = 0; slot < body.network->masses_kg.size(); ++slot)
    if (body.network->masses_kg[slot] > 0) visit(slot);
}

/// Returns whether the body has springs of its own that follow no lattice.
inline bool hasOwnNetwork(const Body& body) {
  return !body.hasCells();
}

/// Returns the length of springs where they are longest [m]: the spacing of lattices, mean lengths of other networks.
inline double longestSpacing(const Model& model) {
  double out = 0;
  for (const Body& body : model.bodies)
    out = std::max(out, hasOwnNetwork(body) ? body.network->meanLength() : body.lattice.spacing_m);
  return out;
}

}  // namespace viscera
