// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "model/body/network_body.h"

#include "math/number_text.h"
#include "model/body/network_builder.h"
#include "model/body/spacing_search.h"
#include "model/scene/structure_rules.h"
#include "viscera/math/error.h"

namespace viscera {
namespace {

/// Returns the slots of a mesh's parts after its vertices have become nodes.
PartNodes partsOf(const TriangleMesh& mesh, const std::vector<uint32_t>& slot_of_vertex) {
  const auto slots = [mesh, slot_of_vertex](uint16_t label) {
    std::vector<uint32_t> out;
    for (size_t t = 0; t < mesh.triangles.size(); ++t) {
      if (mesh.parts[t] + 1 != label) continue;
      for (const uint32_t vertex : mesh.triangles[t]) {
        if (slot_of_vertex[vertex] != UINT32_MAX) out.push_back(slot_of_vertex[vertex]);
      }
    }
    return out;
  };
  return {mesh.part_names, slots};
}

void addMembrane(const BodyConfig& config, const Tissue& tissue, Body& body, PartNodes* parts) {
  const TriangleMesh mesh =
      config.target_nodes > 0 ? shellToNodes(tissue, config.target_nodes) : tissue.shell(config.spacing_m);
  size_t degenerate = 0;
  const SpringNetwork network =
      membraneNetwork(mesh, config.material, config.thickness_m, config.bending_ratio, &degenerate);
  if (network.triangles.empty()) throw LatticeError("all triangles of its surface have zero area");
  const std::vector<uint32_t> slot_of_vertex = adoptNetwork(network, body);
  if (parts) *parts = partsOf(mesh, slot_of_vertex);
  TextOut note;
  note << "surface: " << network.triangles.size() << " triangles as springs, " << config.thickness_m * 1e3
       << " mm thick; " << degenerate << " triangles without area left out";
  body.notes.push_back(note.str());
}

}  // namespace

Body plainBody(const BodyConfig& config) {
  Body body;
  body.name = config.name;
  body.material = config.material;
  body.material.law = lawOf(config);
  body.parts = config.parts;
  body.color = config.color;
  body.roughness = config.roughness;
  body.color_variation = config.color_variation;
  body.specular_wetness = config.specular_wetness;
  body.cut_wall_texture = config.cut_wall_texture;
  body.blanching = config.blanching;
  body.layers = config.layers;
  body.force_n = config.force_n;
  return body;
}

Body networkBody(const BodyConfig& config, const Tissue& tissue, const Progress& progress, PartNodes* parts) {
  Body body = plainBody(config);
  if (progress) progress("build network", 0);
  addMembrane(config, tissue, body, parts);
  body.lattice.part_names = {config.name};
  return body;
}

}  // namespace viscera
