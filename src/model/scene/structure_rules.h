// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <string>

#include "viscera/model/scene/body_config.h"
#include "viscera/model/scene/solver_kinds.h"

namespace viscera {

/// Returns whether the structure has its own nodes instead of a lattice's.
inline bool isNetwork(Structure structure) {
  return structure == Structure::kSurface;
}

/// Returns the law of the body's cells. It is neo-Hookean for lattices with leapfrog, unless the scene chooses springs
/// or something that needs them. Never Law::kAuto.
inline Law lawOf(const BodyConfig& body, Integrator integrator = Integrator::kLeapfrog) {
  const MaterialConfig& material = body.material;
  if (material.law != Law::kAuto) return material.law;
  const bool goes = body.structure == Structure::kLattice && integrator == Integrator::kLeapfrog;
  return goes && material.weights == Weights::kCell ? Law::kNeoHookean : Law::kSprings;
}

/// Returns whether cells at the surface can be partly filled. With springs cells are always full.
inline bool fillsInPart(const BodyConfig& body) {
  return lawOf(body) == Law::kNeoHookean;
}

/// Returns whether the body or a part of it has a Poisson's ratio other than that of springs.
bool hasOwnPoisson(const BodyConfig& body);

/// Returns whether the body or a part of it has a prestress.
bool isPrestressed(const MaterialConfig& material, const std::vector<PartConfig>& parts);
inline bool isPrestressed(const BodyConfig& body) {
  return isPrestressed(body.material, body.parts);
}

/// Returns whether a fluid leaves some body (Body or BodyConfig), or a part of one, where it is cut.
template <class Bodies>
bool mayBleed(const Bodies& bodies, Fluid fluid) {
  const auto bleeds = [fluid](const auto& it) { return it.bleeding.flow_ml_per_min > 0 && it.bleeding.fluid == fluid; };
  return std::any_of(bodies.begin(), bodies.end(), [&](const auto& body) {
    return bleeds(body.material) || std::any_of(body.parts.begin(), body.parts.end(), bleeds);
  });
}

/// Returns whether some body of a scene has pressure in its cavities.
template <class Bodies>
bool hasPressure(const Bodies& bodies) {
  return std::any_of(bodies.begin(), bodies.end(), [](const auto& body) { return body.pressure.mean_pa > 0; });
}

/// Returns what the body's structure cannot be combined with, for a person; empty: no fault.
std::string structureFault(const BodyConfig& body);

}  // namespace viscera
