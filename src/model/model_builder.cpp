// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <limits>
#include <sstream>

#include "model/fixed_nodes.h"
#include "model/spacing_search.h"
#include "model/tissue.h"
#include "viscera/math/error.h"
#include "viscera/model/model.h"

namespace viscera {
namespace {

/// Sizes of the pieces that springs hold together, largest first.
std::vector<size_t> pieces(const Lattice& lattice) {
  std::vector<bool> seen(lattice.nodes.size(), false);
  std::vector<size_t> sizes;
  for (const uint32_t seed : lattice.active_slots) {
    if (seen[seed]) continue;
    std::vector<uint32_t> piece = {seed};
    seen[seed] = true;
    for (size_t next = 0; next < piece.size(); ++next) {
      for (uint32_t spring = 0; spring < layout::kSpringsPerNode; ++spring) {
        if (springCount(lattice.nodes[piece[next]], spring) == 0) continue;
        const auto neighbor = static_cast<uint32_t>(lattice.neighborSlot(piece[next], spring));
        if (seen[neighbor]) continue;
        seen[neighbor] = true;
        piece.push_back(neighbor);
      }
    }
    sizes.push_back(piece.size());
  }
  std::sort(sizes.rbegin(), sizes.rend());
  return sizes;
}

std::string latticeNote(const Lattice& lattice, size_t fixed_nodes) {
  std::ostringstream out;
  out << "lattice: " << lattice.active_slots.size() << " nodes (" << fixed_nodes << " fixed), " << lattice.springs()
      << " springs, spacing " << lattice.spacing_m * 1e3 << " mm";
  return out.str();
}

std::string piecesNote(const std::vector<size_t>& sizes) {
  std::ostringstream out;
  out << "the lattice falls into " << sizes.size() << " pieces; the largest has " << sizes[0] << " nodes, the next "
      << sizes[1];
  return out.str();
}

std::string skinNote(const Skin& skin) {
  std::ostringstream out;
  out << "skin: " << skin.mesh.triangles.size() << " faces, " << skin.mesh.positions_m.size() << " vertices ("
      << skin.deep_vertices << " inside the tissue, " << skin.bridges_removed << " faces across gaps left out)";
  return out.str();
}

TriangleMesh surfaceOf(const Tissue& tissue, const BodyConfig& config, const Solid& solid) {
  return config.skin == SkinSource::kVolume ? extractSkin(solid) : tissue.surface(solid);
}

/// Passes the stages of one body on under its name.
Progress progressOf(const BodyConfig& config, const Progress& progress) {
  if (!progress) return {};
  return [&progress, name = config.name](const std::string& stage, double fraction) {
    progress(name + ": " + stage, fraction);
  };
}

Filling fill(const Tissue& tissue, const BodyConfig& config, const Progress& progress) {
  if (config.target_nodes > 0) return fillToNodes(tissue, config.target_nodes, progress);
  if (config.auto_spacing) return fillToNodes(tissue, kUnmeasuredNodes, progress);
  return tissue.fill(config.spacing_m, progress);
}

Body buildBody(const BodyConfig& config, const std::string& folder, const Progress& all_progress) {
  const Progress progress = progressOf(config, all_progress);
  Body body;
  body.name = config.name;
  body.material = config.material;
  body.parts = config.parts;
  body.color = config.color;
  if (progress) progress("read", 0);
  const std::unique_ptr<Tissue> tissue = makeTissue(config, folder);
  body.notes = tissue->notes;
  const Filling filling = fill(*tissue, config, progress);
  if (!config.spacing_note.empty()) body.notes.push_back(config.spacing_note);
  if (!filling.note.empty()) body.notes.push_back(filling.note);
  if (progress) progress("build lattice", 0);
  body.lattice = buildLattice(filling.solid, config.material.weights);
  const size_t fixed_nodes = fixNodes(config, filling.solid, body.lattice);
  body.notes.push_back(latticeNote(body.lattice, fixed_nodes));
  const std::vector<size_t> sizes = pieces(body.lattice);
  if (sizes.size() > 1) body.notes.push_back(piecesNote(sizes));
  if (progress) progress("extract skin", 0);
  body.skin = bindSkin(surfaceOf(*tissue, config, filling.solid), body.lattice, filling.solid, progress);
  body.notes.push_back(skinNote(body.skin));
  return body;
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
  Model model;
  for (const BodyConfig& config : scene.bodies) {
    try {
      model.bodies.push_back(buildBody(config, scene.folder, progress));
    } catch (const LatticeError& error) {
      throw LatticeError("body '" + config.name + "': " + error.what());
    }
  }
  if (!canMove(model))
    throw SceneError("every node of the scene is fixed: nothing can move; make a 'fixed' region smaller");
  if (model.slots() > std::numeric_limits<uint32_t>::max()) {
    throw LatticeError("the bodies need " + std::to_string(model.slots()) + " node slots together, more than 2^32");
  }
  return model;
}

}  // namespace viscera
