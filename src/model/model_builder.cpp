// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <limits>

#include "math/memory_for.h"
#include "math/number_text.h"
#include "model/body/body_notes.h"
#include "model/body/detailed_surface.h"
#include "model/body/fixed_nodes.h"
#include "model/body/network_body.h"
#include "model/body/network_builder.h"
#include "model/body/network_skin.h"
#include "model/body/spacing_search.h"
#include "model/fracture/prestress.h"
#include "model/fracture/tearing.h"
#include "model/fracture/toughness.h"
#include "model/scene/host_memory.h"
#include "model/scene/key_location.h"
#include "model/scene/structure_rules.h"
#include "model/scene/tissue_presets.h"
#include "model/scene/tool_kinds.h"
#include "model/shape/organ/tissue.h"
#include "model/shape/organ/unit_question.h"
#include "viscera/math/error.h"
#include "viscera/model/body/elasticity.h"
#include "viscera/model/body/wall_cells.h"
#include "viscera/model/body/wall_thickness.h"

namespace viscera {
namespace {

TriangleMesh surfaceOf(const Tissue& tissue, const BodyConfig& config, const Solid& solid) {
  return config.skin == SkinSource::kVolume ? extractSkin(solid) : tissue.surface(solid);
}

/// Returns a progress callback that prefixes stages with the name of a body.
Progress progressOf(const BodyConfig& config, const Progress& progress) {
  if (!progress) return {};
  return [&progress, name = config.name](const std::string& stage, double fraction) {
    progress(name + ": " + stage, fraction);
  };
}

void addPiecesNote(const BodyConfig& config, Body& body) {
  std::string note = piecesNote(body);
  if (note.empty()) return;
  const bool of_parts = config.source == TissueSource::kMesh && config.fill == Fill::kParts;
  if (of_parts && body.hasCells())
    note += "; if the parts belong together, set fill: enclosed, which bridges gaps between them";
  body.notes.push_back(note);
}

void addToughnessNotes(Body& body) {
  for (const std::string& note : toughnessNotes(body)) body.notes.push_back(note);
}

void addNotes(const std::vector<std::string>& notes, Body& body) {
  body.notes.insert(body.notes.begin(), notes.begin(), notes.end());
}

Body buildLatticeBody(const BodyConfig& config, const Scene& scene, const Tissue& tissue, bool can_be_cut,
                      const Progress& progress) {
  Body body = plainBody(config);
  addNotes(tissue.notes, body);
  const Filling filling = fill(tissue, config, progress);
  const Solid& solid = filling.solid;
  requireTissueMemory(solid.filledCells(), solid.spacing_m, bytesPerFilledCell(scene),
                      availableBytes() - kBytesPerPartialCell * solid.partial.size());
  if (!config.spacing_note.empty()) body.notes.push_back(config.spacing_note);
  if (!filling.note.empty()) body.notes.push_back(filling.note);
  if (progress) progress("build lattice", 0);
  body.lattice = buildLattice(solid, config.material.weights);
  const auto slots = [&](uint16_t label) { return slotsOfPart(label, solid, body.lattice); };
  const size_t fixed_nodes = fixNodes(config, {solid.part_names, slots}, body);
  body.notes.push_back(latticeNote(body.lattice, fixed_nodes));
  addToughnessNotes(body);
  const std::string walls = wallsNote(tissue.walls(), solid.spacing_m);
  if (!walls.empty()) body.notes.push_back(walls);
  const std::string laminates = laminatesNote(body);
  if (!laminates.empty()) body.notes.push_back(laminates);
  addPiecesNote(config, body);
  if (progress) progress("extract skin", 0);
  const TriangleMesh surface =
      detailedSurface(surfaceOf(tissue, config, solid),
                      {config, scene.folder, tissue.file_pose, solid.spacing_m, tissue.paint()}, body.notes, progress);
  body.skin = bindSkin(withPartColors(surface, config.parts), body.lattice, solid, config.mapping, progress);
  body.skin.can_be_cut = can_be_cut;
  body.notes.push_back(skinNote(body.skin));
  const std::optional<WallThickness> thickness = wallThickness(body);
  const Walls bent_by = body.material.walls;
  if (thickness && expectedWallError(thickness->tenth_m / solid.spacing_m, bent_by).most > kNotedWallError)
    body.notes.push_back(wallThicknessText(*thickness, solid.spacing_m, bent_by));
  if (config.structure != Structure::kExplicit) {
    addCellPrestress(body);
    addRowGhosts(body);
    return body;
  }
  body.network = latticeNetwork(body, config.bending_ratio);
  body.notes.push_back(linksNote(*body.network));
  return body;
}

Body buildNetworkBody(const BodyConfig& config, const Tissue& tissue, bool can_be_cut, const Progress& progress) {
  PartNodes parts;
  Body body = networkBody(config, tissue, progress, &parts);
  addNotes(tissue.notes, body);
  const size_t fixed_nodes = fixNodes(config, parts, body);
  body.notes.push_back(networkNote(body, fixed_nodes));
  addToughnessNotes(body);
  addSheetPrestress(body);
  addPiecesNote(config, body);
  if (progress) progress("extract skin", 0);
  body.skin = bindNetworkSkin(*body.network, can_be_cut);
  body.skin.can_be_cut = can_be_cut;
  body.notes.push_back(skinNote(body.skin));
  return body;
}

/// Returns the key that determines the size of a body, for a person.
std::string sizeKey(const BodyConfig& config) {
  if (config.target_nodes > 0) return "target_nodes " + std::to_string(config.target_nodes);
  TextOut out;
  out << "spacing_m " << config.spacing_m;
  return config.auto_spacing ? "spacing_m auto" : out.str();
}

bool isTooWide(const BodyConfig& config, const Tissue& tissue) {
  return config.source == TissueSource::kMesh && tissue.bounds().sizes().maxCoeff() > kWidestOrgan_m;
}

Body buildBody(const BodyConfig& config, const Scene& scene, bool can_be_cut, const Progress& all_progress) {
  const Progress body_progress = progressOf(config, all_progress);
  std::string stage = "read";
  const Progress progress = [&](const std::string& name, double fraction) {
    stage = name;
    if (body_progress) body_progress(name, fraction);
  };
  std::unique_ptr<Tissue> tissue;
  const auto build = [&] {
    progress("read", 0);
    tissue = makeTissue(config, scene.folder);
    Body body = isNetwork(config.structure) ? buildNetworkBody(config, *tissue, can_be_cut, progress)
                                            : buildLatticeBody(config, scene, *tissue, can_be_cut, progress);
    addNotes(tissueNotes(config), body);
    if (!config.parts.empty()) elasticityByLabel(body);  // checks the names of the parts
    return body;
  };
  try {
    return memoryFor<LatticeError>([&] { return "stage '" + stage + "' with " + sizeKey(config); }, build);
  } catch (const LatticeError& error) {
    if (!tissue || !isTooWide(config, *tissue)) throw;
    throw LatticeError(unitQuestion(config, tissue->bounds().sizes()) + " " + error.what());
  }
}

bool canMove(const Model& model) {
  for (const Body& body : model.bodies) {
    for (const uint32_t slot : body.lattice.active_slots) {
      if (!isFixed(body.lattice.nodes[slot])) return true;
    }
  }
  return false;
}

}  // namespace

Model buildModel(const Scene& scene, const Progress& progress) {
  const bool can_be_cut = maySever(scene.styluses) || tears(scene) || suturesTear(scene);
  const std::string file = scene.file.empty() ? "" : scene.file + ": ";
  Model model;
  for (size_t b = 0; b < scene.bodies.size(); ++b) {
    BodyConfig config = scene.bodies[b];
    config.material.law = lawOf(config, scene.solver.integrator);
    try {
      model.bodies.push_back(withLocation(scene, b, [&] { return buildBody(config, scene, can_be_cut, progress); }));
    } catch (const PlacedError&) {
      throw;
    } catch (const SceneError& error) {  // names the body already
      throw SceneError(file + error.what());
    } catch (const LatticeError& error) {
      throw LatticeError(file + "body '" + config.name + "': " + error.what());
    }
  }
  if (scene.fit && !model.bodies.empty()) model.bodies[0].notes.push_back(scene.fit->text());
  if (!canMove(model))
    throw SceneError(file + "every node of the scene is fixed, so nothing can move; make a 'fixed' region smaller");
  if (model.slots() > std::numeric_limits<uint32_t>::max()) {
    throw LatticeError(file + "the bodies need " + std::to_string(model.slots()) +
                       " node slots in total; at most 2^32 are accepted");
  }
  return model;
}

}  // namespace viscera
