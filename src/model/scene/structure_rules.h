// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <string>

#include "viscera/model/scene/body_config.h"
#include "viscera/model/scene/solver_config.h"

namespace viscera {

/// Nodes of its own instead of a lattice's?
inline bool isNetwork(Structure structure) {
  return structure == Structure::kSurface;
}

/// Do the body's cells resist by moments (Cells)? By default those of lattices do, unless their springs are weighted as
/// in the paper.
inline bool hasMoments(const BodyConfig& body) {
  if (body.material.cells != Cells::kAuto) return body.material.cells == Cells::kMoments;
  return !isNetwork(body.structure) && body.material.weights == Weights::kCell;
}

/// The law that the body's cells obey: of lattices that leapfrog steps the neo-Hookean one, unless the scene asks for
/// springs or for what goes with them alone. Never Law::kAuto.
inline Law lawOf(const BodyConfig& body, Integrator integrator = Integrator::kLeapfrog) {
  const MaterialConfig& material = body.material;
  if (material.law != Law::kAuto) return material.law;
  const bool plain = material.cells == Cells::kAuto && material.weights == Weights::kCell && !material.thin_walls;
  const bool goes = body.structure == Structure::kLattice && integrator == Integrator::kLeapfrog;
  return goes && plain ? Law::kNeoHookean : Law::kSprings;
}

/// Do springs of the body or of a part of it pull where they are?
bool isPrestressed(const MaterialConfig& material, const std::vector<PartConfig>& parts);
inline bool isPrestressed(const BodyConfig& body) {
  return isPrestressed(body.material, body.parts);
}

/// Does blood run out of some body (Body or BodyConfig) or part of one where it is cut?
template <class Bodies>
bool mayBleed(const Bodies& bodies) {
  const auto bleeds = [](const auto& it) { return it.bleeding.flow_ml_per_min > 0; };
  return std::any_of(bodies.begin(), bodies.end(), [&](const auto& body) {
    return bleeds(body.material) || std::any_of(body.parts.begin(), body.parts.end(), bleeds);
  });
}

/// What a body's structure does not go with, for a person; empty: nothing.
std::string structureFault(const BodyConfig& body);

}  // namespace viscera
