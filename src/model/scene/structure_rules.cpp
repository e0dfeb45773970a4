// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "model/scene/structure_rules.h"

#include <algorithm>

#include "model/scene/yaml/yaml_reader.h"

namespace viscera {
namespace {

std::string sourceFault(const BodyConfig& body) {
  if (body.source == TissueSource::kSheet && body.structure != Structure::kSurface) {
    return "source sheet has no volume: it needs structure surface";
  }
  const bool from_labels = body.source == TissueSource::kLabels;
  if (body.skin == SkinSource::kInput && body.source != TissueSource::kMesh && !from_labels) {
    return "skin: input needs source: mesh or labels; use auto or volume";
  }
  if (body.fill == Fill::kEnclosed && (body.source != TissueSource::kMesh || isNetwork(body.structure))) {
    return "fill: enclosed needs source mesh and structure lattice or explicit";
  }
  return "";
}

/// Keys that only lattices have.
std::string networkFault(const BodyConfig& body) {
  if (body.material.poisson_ratio != MaterialConfig{}.poisson_ratio) {
    return "material.poisson_ratio = " + numberText(body.material.poisson_ratio) +
           " does not go with structure "
           "surface, whose springs give what they give (1/3 in a sheet): leave it out";
  }
  if (!body.parts.empty()) return "parts need structure lattice or explicit, not surface";
  for (const LayerConfig& layer : body.layers) {
    if (layer.toughness_j_per_m2 > 0)
      return "layers[].toughness_j_per_m2 must be 0 with structure surface, which has no depth";
  }
  if (body.material.weights != Weights::kCell) return "material.weights: paper needs structure lattice or explicit";
  if (body.material.cells == Cells::kMoments) return "material.cells: moments needs structure lattice or explicit";
  if (body.skin != SkinSource::kAuto) return "skin must be auto with structure surface: the skin is its surface";
  if (body.mapping != Mapping::kAuto) {
    return "mapping must be auto with structure surface: each vertex of its skin is one of its nodes already";
  }
  for (const char* key : {body.detail_mesh.empty() ? "" : "detail_mesh", body.skin_faces > 0 ? "skin_faces" : ""}) {
    if (*key != 0) return key + std::string(" needs structure lattice or explicit: the skin of surface is its nodes");
  }
  if (body.auto_spacing && body.target_nodes == 0) {
    return "spacing_m: auto needs structure lattice or explicit; give surface a number or target_nodes";
  }
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
  const std::string fault = sourceFault(body);
  if (!fault.empty()) return fault;
  if (isNetwork(body.structure)) {
    const std::string network_fault = networkFault(body);
    if (!network_fault.empty()) return network_fault;
  }
  const bool can_bend = body.structure == Structure::kSurface || body.structure == Structure::kExplicit;
  if (body.structure == Structure::kLattice && isPrestressed(body))
    return "material.prestress needs structure explicit or surface: springs of a lattice have one rest "
           "length";
  if (hasMoments(body) && body.material.weights != Weights::kCell)
    return "material.cells: moments does not go with material.weights: paper";
  if (body.material.thin_walls && !hasMoments(body))
    return "material.thin_walls needs cells by moments: structure lattice or explicit, cells auto or moments, weights "
           "cell";
  if (body.bending_ratio > 0 && !can_bend) return "bending_ratio must be 0 unless structure is surface or explicit";
  return "";
}

}  // namespace viscera
