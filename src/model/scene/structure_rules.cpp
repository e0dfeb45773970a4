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
    return "skin: input needs source: mesh or labels; use auto or volume";
  if (body.fill == Fill::kEnclosed && !has_mesh) return "fill: enclosed needs source mesh";
  return "";
}

std::string lawFault(const BodyConfig& body) {
  const MaterialConfig& material = body.material;
  if (lawOf(body) == Law::kSprings)
    return material.stiffening > 0 ? "material.stiffening needs material.law: neo_hookean" : "";
  if (material.cells == Cells::kSprings) return "material.cells: springs does not go with material.law: neo_hookean";
  if (material.weights != Weights::kCell) return "material.weights: paper does not go with material.law: neo_hookean";
  if (material.thin_walls) return "material.thin_walls does not go with material.law: neo_hookean";
  return "";
}

bool isNone(const PrestressConfig& c) {
  return c.strain == 0 && c.strains.isZero(0);
}

}  // namespace

bool isPrestressed(const MaterialConfig& material, const std::vector<PartConfig>& parts) {
  return !isNone(material.prestress) ||
         std::any_of(parts.begin(), parts.end(), [](const PartConfig& part) { return !isNone(part.prestress); });
}

std::string structureFault(const BodyConfig& body) {
  for (const std::string& fault : {featureFault(body), sourceFault(body)}) {
    if (!fault.empty()) return fault;
  }
  if (hasMoments(body) && body.material.weights != Weights::kCell)
    return "material.cells: moments does not go with material.weights: paper";
  if (body.material.thin_walls && !hasMoments(body))
    return "material.thin_walls needs cells by moments: cells auto or moments, weights cell";
  return lawFault(body);
}

}  // namespace viscera
