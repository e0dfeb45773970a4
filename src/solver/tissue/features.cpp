// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "solver/tissue/features.h"

#include <algorithm>

#include "model/fracture/tearing.h"
#include "model/scene/tool_kinds.h"
#include "solver/tissue/joined_lattice.h"
#include "solver/tissue/substeps.h"
#include "viscera/model/scene/scene.h"
#include "viscera/solver/material.h"

namespace viscera {

uint32_t contactRows(bool tools, uint32_t obstacles) {
  return std::min<uint32_t>(layout::kMostContacts, (tools ? layout::kMaxStyluses : 0) + obstacles);
}

std::vector<std::string> FeatureSet::defines() const {
  std::vector<std::string> out = {"GROUP_SIZE " + std::to_string(group_size), "TEXELS"};
  if (lattice) out.push_back("LATTICE");
  if (network) out.push_back("NETWORK");
  if (dashpot) out.push_back("DASHPOT");
  if (predicted) out.push_back("PREDICTED");
  if (law) out.push_back("LAW");
  if (prestress) out.push_back("PRESTRESS");
  if (laminates) out.push_back("LAMINATES");
  if (walls) out.push_back("WALLS");
  if (!springs) out.push_back("NO_SPRINGS");
  if (parts) out.push_back("PARTS");
  if (compensated) out.push_back("COMPENSATED");
  if (single_body) out.push_back("SINGLE_BODY");
  if (cuts && lattice) out.push_back("RECORD");
  if (shafts) out.push_back("SHAFTS");
  return out;
}

FeatureSet featuresOf(const Model& model, const Scene& scene, double dt_s, uint32_t group_size) {
  FeatureSet features;
  features.group_size = group_size;
  features.single_body = model.bodies.size() == 1;
  features.lattice = model.hasLattice();
  features.network = model.hasNetwork();
  features.law = hasLaw(model);
  features.prestress = hasCellPrestress(model);
  features.laminates = hasLaminates(model);
  features.walls = hasWalls(model);
  features.springs = std::any_of(model.bodies.begin(), model.bodies.end(),
                                 [](const Body& body) { return body.material.law != Law::kNeoHookean; });
  features.parts = isHeterogeneous(model);
  features.compensated = isCompensated(scene.solver, dt_s);
  features.tools = !scene.styluses.empty();
  features.shafts = meetsShafts(scene.styluses);
  features.cuts = maySever(scene.styluses) || tears(scene) || suturesTear(scene);
  features.tears = tears(scene);
  features.obstacles = static_cast<uint32_t>(scene.obstacles.size());
  features.dashpot = largestDashpot(model) > 0;
  features.predicted = predictsSprings(model);
  return features;
}

}  // namespace viscera
