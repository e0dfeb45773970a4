// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <string>

#include "viscera/model/scene/body_config.h"
#include "viscera/model/scene/solver_kinds.h"

namespace viscera {

/// Nodes of its own instead of a lattice's?
inline bool isNetwork(Structure structure) {
  return structure == Structure::kSurface;
}

/// The law that the body's cells obey: of lattices that leapfrog steps the neo-Hookean one, unless the scene asks for
/// springs or for what goes with them alone. Never Law::kAuto.
inline Law lawOf(const BodyConfig& body, Integrator integrator = Integrator::kLeapfrog) {
  const MaterialConfig& material = body.material;
  if (material.law != Law::kAuto) return material.law;
  const bool goes = body.structure == Structure::kLattice && integrator == Integrator::kLeapfrog;
  return goes && material.weights == Weights::kCell ? Law::kNeoHookean : Law::kSprings;
}

/// Are cells at the surface tissue in part? Springs have full cells alone.
inline bool fillsInPart(const BodyConfig& body) {
  return lawOf(body) == Law::kNeoHookean;
}

/// Has the body or a part of it another Poisson's ratio than springs have?
bool hasOwnPoisson(const BodyConfig& body);

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
