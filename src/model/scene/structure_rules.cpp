// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "model/scene/structure_rules.h"

#include <algorithm>

#include "model/scene/feature_rules.h"

namespace viscera {
namespace {

std::string sourceFault(const BodyConfig& body) {
  const bool has_mesh = body.source == TissueSource::kMesh;
  if (body.skin == SkinSource::kInput && !has_mesh && body.source != TissueSource::kLabels)
    return "skin: input needs source: mesh or labels; otherwise use auto or volume";
  if (body.fill == Fill::kEnclosed && !has_mesh) return "fill: enclosed needs source mesh";
  return "";
}

std::string lawFault(const BodyConfig& body) {
  const MaterialConfig& material = body.material;
  if (lawOf(body) == Law::kSprings) {
    if (isPrestressed(body) && body.structure == Structure::kLattice)
      return "material.prestress of structure lattice needs material.law: neo_hookean";
    if (material.stiffening > 0) return "material.stiffening needs material.law: neo_hookean";
    if (material.walls == Walls::kRows) return "material.walls: rows needs material.law: neo_hookean";
    return hasOwnPoisson(body) ? "poisson_ratio other than 0.25 needs material.law: neo_hookean: springs have 1/4" : "";
  }
  if (material.weights != Weights::kCell)
    return "material.weights: paper cannot be combined with material.law: neo_hookean";
  if (material.walls == Walls::kRows && isPrestressed(body))
    return "material.walls: rows cannot be combined with material.prestress";
  return "";
}

bool isNone(const PrestressConfig& c) {
  return c.strain == 0 && c.strains.isZero(0);
}

}  // namespace

bool hasOwnPoisson(const BodyConfig& body) {
  const auto is_other = [](double nu) { return nu != MaterialConfig{}.poisson_ratio; };
  return is_other(body.material.poisson_ratio) ||
         std::any_of(body.parts.begin(), body.parts.end(),
                     [&](const PartConfig& p) { return is_other(p.poisson_ratio); });
}

bool isPrestressed(const MaterialConfig& material, const std::vector<PartConfig>& parts) {
  return !isNone(material.prestress) ||
         std::any_of(parts.begin(), parts.end(), [](const PartConfig& part) { return !isNone(part.prestress); });
}

std::string structureFault(const BodyConfig& body) {
  for (const std::string& fault : {featureFault(body), sourceFault(body)}) {
    if (!fault.empty()) return fault;
  }
  return lawFault(body);
}

}  // namespace viscera
