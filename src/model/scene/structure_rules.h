// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "viscera/model/scene/scene.h"

namespace viscera {

/// Nodes of its own instead of a lattice's?
inline bool isNetwork(Structure structure) {
  return structure == Structure::kSurface || structure == Structure::kTetrahedra;
}

/// Do the body's cells resist by moments (Cells)? By default those of lattices do, unless their springs are weighted as
/// in the paper.
inline bool hasMoments(const BodyConfig& body) {
  if (body.material.cells != Cells::kAuto) return body.material.cells == Cells::kMoments;
  return !isNetwork(body.structure) && body.material.weights == Weights::kCell;
}

/// Do springs of the body or of a part of it pull where they are?
bool isPrestressed(const MaterialConfig& material, const std::vector<PartConfig>& parts);
inline bool isPrestressed(const BodyConfig& body) {
  return isPrestressed(body.material, body.parts);
}

/// What a body's structure does not go with, for a person; empty: nothing.
std::string structureFault(const BodyConfig& body);

}  // namespace viscera
