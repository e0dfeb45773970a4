// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "surface/wounds/wounds.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <utility>

#include "surface/skins/keep_room.h"
#include "surface/skins/part_colors.h"
#include "viscera/surface/visible_mesh.h"

namespace viscera {

namespace {

uint32_t rgba(const Vector3d& color, uint32_t body) {
  uint32_t out = wallAlpha(body) << 24U;
  for (int i = 0; i < 3; ++i) {
    out |= static_cast<uint32_t>(std::lround(255 * std::clamp(color[i], 0.0, 1.0))) << (8 * i);
  }
  return out;
}

bool canBeWounded(const Body& body) {
  return body.skin.can_be_cut && !isOneToOne(body);
}

/// Returns a binding of a body with global slots. @param slot  first one of the body
layout::SkinBinding numbered(uint32_t slot, layout::SkinBinding binding) {
  binding.slot0 += slot;
  binding.slot1 += slot;
  binding.slot2 += slot;
  return binding;
}

/// Returns the label of the cell around a point, else that of a corner with tissue; 0: none. @param point  in cells
uint16_t labelAt(const Lattice& lattice, const Vector3d& point) {
  const Vector3i cell = point.array().floor().cast<int>();
  const int64_t lowest = lattice.slotAt(cell);
  uint16_t label = lowest < 0 ? uint16_t{0} : lattice.cell_labels[static_cast<size_t>(lowest)];
  for (int c = 0; c < 8 && label == 0; ++c) {
    const int64_t slot = lattice.slotAt(cell + Vector3i(c & 1, (c >> 1) & 1, (c >> 2) & 1));
    if (slot >= 0) label = lattice.labels[static_cast<size_t>(slot)];
  }
  return label;
}

}  // namespace

bool Wounds::possible(const Model& model) {
  return std::any_of(model.bodies.begin(), model.bodies.end(), canBeWounded);
}

Wounds::Wounds(const Model& model, const JoinedSkins& skins)
    : slots_(model.slots()),
      whole_bindings_(skins.bindings),
      bindings_(skins.bindings),
      whole_colors_(skins.colors),
      colors_(skins.colors) {
  uint32_t vertex = 0;
  for (size_t b = 0; b < model.bodies.size(); ++b) {
    const Body& body = model.bodies[b];
    WoundOfBody position;
    position.slot = model.slotOffset(b);
    position.vertex = vertex;
    for (const Vector3d& color : insideColors(body)) position.inside.push_back(rgba(color, static_cast<uint32_t>(b)));
    position.lattice = &body.lattice;
    position.origin_m = body.lattice.origin_m;
    position.spacing_m = body.lattice.spacing_m;
    position.number = static_cast<uint32_t>(b);
    if (canBeWounded(body)) {
      position.wound = std::make_unique<BodyWound>(body.skin, body.lattice);
      position.depths = std::make_unique<WoundDepths>(body.skin, body.lattice);
    }
    positions_.push_back(std::move(position));
    vertex += static_cast<uint32_t>(body.skin.bindings.size() + 2 * body.skin.split_edges.size());
  }
  reset();
}

void Wounds::reset() {
  springs_.clear();
  clear();
  for (const WoundOfBody& position : positions_) {
    if (position.wound) position.wound->makeWhole();
  }
  shown_ = next();
}

/// Makes all surface meshes whole again.
void Wounds::clear() {
  for (const WoundOfBody& position : positions_) {
    if (!position.wound) continue;
    for (const uint32_t own : position.wound->rebound())
      bindings_[position.vertex + own] = whole_bindings_[position.vertex + own];
  }
  bindings_.resize(whole_bindings_.size());
  colors_.resize(whole_colors_.size());
  added_rests_.clear();
}

/// Returns a result that is not shown any more, with its memory, or a new one. All bodies in it are whole.
std::shared_ptr<VisibleWounds> Wounds::next() {
  const auto is_free = [](const std::shared_ptr<VisibleWounds>& wounds) { return wounds.use_count() == 1; };
  shown_.reset();
  auto found = std::find_if(kept_.begin(), kept_.end(), is_free);
  if (found == kept_.end()) found = kept_.insert(kept_.end(), std::make_shared<VisibleWounds>());
  std::atomic_thread_fence(std::memory_order_acquire);  // pairs with the release of the last user
  VisibleWounds& out = **found;
  out.revision = revisions_++;
  out.vertices = bindings_.size();
  out.holes = out.slivers = 0;
  out.bodies.resize(positions_.size());
  for (VisibleWounds::OfBody& body : out.bodies) {
    body.wounded = false;
    body.skin.clear();
    body.walls.clear();
    body.skin_sources.clear();
  }
  return *found;
}

/// Appends triangles with global vertex numbers: a wound numbers the body's own vertices first, then those it has
/// added, which follow all others here.
void Wounds::appendTriangles(const WoundOfBody& position, const BodyWound& wound, VisibleWounds::OfBody& out) const {
  const auto own = static_cast<uint32_t>(wound.ownVertices()), first_added = static_cast<uint32_t>(bindings_.size());
  const auto number = [&](const std::vector<uint32_t>& triangles, std::vector<uint32_t>& all) {
    keepRoom(all, triangles.size());
    all = triangles;
    for (uint32_t& vertex : all) vertex = vertex < own ? position.vertex + vertex : first_added + (vertex - own);
  };
  out.wounded = true;
  number(wound.skinTriangles(), out.skin);
  number(wound.wallTriangles(), out.walls);
  keepRoom(out.skin_sources, wound.skinSources().size());
  out.skin_sources = wound.skinSources();
}

void Wounds::append(WoundOfBody& position, VisibleWounds::OfBody& out) {
  const BodyWound& wound = *position.wound;
  const auto own = static_cast<uint32_t>(wound.ownVertices());
  appendTriangles(position, wound, out);
  for (const uint32_t vertex : wound.rebound())
    bindings_[position.vertex + vertex] = numbered(position.slot, wound.bindings()[vertex]);
  for (size_t v = own; v < wound.bindings().size(); ++v)
    bindings_.push_back(numbered(position.slot, wound.bindings()[v]));
  for (const WoundVertex& vertex : wound.lipVertices()) {
    colors_.push_back(whole_colors_[position.vertex + vertex.skin_vertex]);
    addRest(position, vertex, kOnLip);
  }
  const std::vector<WoundVertex>& walls = wound.wallVertices();
  keepRoom(position.wall_depths_m, walls.size());
  position.wall_depths_m.resize(walls.size());
  keepRoom(position.wall_labels, walls.size());
  position.wall_labels.resize(walls.size());
  for (const uint32_t v : wound.changedWalls()) {
    position.wall_depths_m[v] = walls[v].skin_vertex == WoundVertex::kNone ? position.depths->at(walls[v].point) : 0;
    position.wall_labels[v] = labelAt(*position.lattice, walls[v].point);
  }
  for (size_t v = 0; v < walls.size(); ++v) {
    colors_.push_back(position.inside[position.wall_labels[v]]);
    addRest(position, walls[v], position.wall_depths_m[v]);
  }
}

void Wounds::addRest(const WoundOfBody& position, const WoundVertex& vertex, double w) {
  const Vector3f at = (position.origin_m + position.spacing_m * vertex.point).cast<float>();
  added_rests_.push_back({at.x(), at.y(), at.z(), static_cast<float>(w)});
}

/// Returns whether these are the springs of the last update. A blade in the air changes none.
bool Wounds::isKnown(const layout::NodeBits* nodes) {
  const bool first = springs_.empty();
  springs_.resize(slots_);
  bool known = !first;
  for (size_t slot = 0; slot < slots_; ++slot) {
    const layout::NodeBits now = {nodes[slot].lo & (layout::kAxialMask | layout::kSeveredBit),
                                  nodes[slot].hi & layout::kDiagonalMask};
    known = known && now.lo == springs_[slot].lo && now.hi == springs_[slot].hi;
    springs_[slot] = now;
  }
  return known;
}

bool Wounds::update(const CutSprings& cuts) {
  if (isKnown(cuts.nodes.data())) return false;
  clear();
  const std::shared_ptr<VisibleWounds> now = next();
  const float* const axial_cut = cuts.axial_cut.empty() ? nullptr : cuts.axial_cut.data();
  for (size_t b = 0; b < positions_.size(); ++b) {
    WoundOfBody& position = positions_[b];
    const layout::NodeBits* const nodes = cuts.nodes.data() + position.slot;
    if (!position.wound) continue;
    position.wound->update(nodes, axial_cut ? axial_cut + 3 * size_t{position.slot} : nullptr);
    if (!position.wound->any()) continue;
    append(position, now->bodies[b]);
    now->holes += position.wound->holes();
    now->slivers += position.wound->slivers();
  }
  now->vertices = bindings_.size();
  shown_ = now;
  return true;
}

}  // namespace viscera
