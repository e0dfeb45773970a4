// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "surface/wounds.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "surface/part_colors.h"
#include "viscera/surface/shown_mesh.h"

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

}  // namespace

bool Wounds::possible(const Model& model) {
  return std::any_of(model.bodies.begin(), model.bodies.end(), canBeWounded);
}

Wounds::Wounds(const Model& model, const JoinedSkins& skins)
    : slots_(model.slots()), whole_bindings_(skins.bindings), whole_colors_(skins.colors) {
  uint32_t vertex = 0;
  for (size_t b = 0; b < model.bodies.size(); ++b) {
    const Body& body = model.bodies[b];
    Place place{nullptr, model.slotOffset(b),     vertex, body.color, body.lattice.origin_m, body.lattice.spacing_m,
                nullptr, static_cast<uint32_t>(b)};
    if (canBeWounded(body)) {
      place.wound = std::make_unique<BodyWound>(body.skin, body.lattice);
      place.depths = std::make_unique<WoundDepths>(body.skin, body.lattice);
    }
    places_.push_back(std::move(place));
    vertex += static_cast<uint32_t>(body.skin.bindings.size() + 2 * body.skin.split_edges.size());
  }
  reset();
}

void Wounds::reset() {
  springs_.clear();
  showWhole();
}

void Wounds::showWhole() {
  bindings_ = whole_bindings_;
  colors_ = whole_colors_;
  added_rests_.clear();
  auto none = std::make_shared<ShownWounds>();
  none->revision = revisions_++;
  none->vertices = bindings_.size();
  none->bodies.resize(places_.size());
  shown_ = std::move(none);
}

void Wounds::append(const Place& place, ShownWounds::OfBody& out) {
  const BodyWound& wound = *place.wound;
  const auto own = static_cast<uint32_t>(wound.ownVertices()), first_added = static_cast<uint32_t>(bindings_.size());
  const auto numbered = [&](const std::vector<uint32_t>& triangles) {
    std::vector<uint32_t> all = triangles;
    for (uint32_t& vertex : all) vertex = vertex < own ? place.vertex + vertex : first_added + (vertex - own);
    return all;
  };
  out = {true, numbered(wound.skinTriangles()), numbered(wound.wallTriangles()), wound.skinSources()};
  for (size_t v = 0; v < wound.bindings().size(); ++v) {
    layout::SkinBinding binding = wound.bindings()[v];
    binding.slot0 += place.slot;
    binding.slot1 += place.slot;
    binding.slot2 += place.slot;
    if (v < own) {
      bindings_[place.vertex + v] = binding;
    } else {
      bindings_.push_back(binding);
    }
  }
  for (const WoundVertex& vertex : wound.lipVertices()) {
    colors_.push_back(whole_colors_[place.vertex + vertex.skin_vertex]);
    addRest(place, vertex, 0);
  }
  const uint32_t flesh = rgba(woundColor(place.color), place.number);
  for (const WoundVertex& vertex : wound.wallVertices()) {
    colors_.push_back(flesh);
    addRest(place, vertex, vertex.skin_vertex == WoundVertex::kNone ? place.depths->at(vertex.point) : 0);
  }
}

void Wounds::addRest(const Place& place, const WoundVertex& vertex, double depth_m) {
  const Vector3f at = (place.origin_m + place.spacing_m * vertex.point).cast<float>();
  added_rests_.push_back({at.x(), at.y(), at.z(), static_cast<float>(depth_m)});
}

/// Are these the springs of the last update? A blade that moves through the air changes none.
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

bool Wounds::update(const layout::NodeBits* nodes, const float* axial_cut) {
  if (isKnown(nodes)) return false;
  showWhole();
  auto next = std::make_shared<ShownWounds>(*shown_);
  for (size_t b = 0; b < places_.size(); ++b) {
    const Place& place = places_[b];
    if (!place.wound) continue;
    place.wound->update(nodes + place.slot, axial_cut + 3 * size_t{place.slot});
    if (place.wound->any()) append(place, next->bodies[b]);
  }
  next->vertices = bindings_.size();
  shown_ = std::move(next);
  return true;
}

}  // namespace viscera
