// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "surface/skins/joined_skins.h"

#include <algorithm>
#include <array>
#include <iterator>
#include <numeric>

#include "model/body/skin_basis.h"
#include "surface/skins/part_colors.h"

namespace viscera {
namespace {

/// Returns where the ring of each vertex begins, [vertices + 1].
std::vector<uint32_t> ringStarts(const TriangleMesh& mesh) {
  std::vector<uint32_t> starts(mesh.positions_m.size() + 1);
  for (const auto& triangle : mesh.triangles) {
    for (uint32_t vertex : triangle) ++starts[vertex + 1];
  }
  std::partial_sum(starts.begin(), starts.end(), starts.begin());
  return starts;
}

/// Returns the vertex of a split edge at its end a or b; these follow the body's own vertices.
uint32_t splitVertex(const Skin& skin, const NetworkSkins::Offsets& offsets, uint32_t edge, bool at_b) {
  return offsets.vertex + static_cast<uint32_t>(skin.bindings.size()) + 2 * edge + (at_b ? 1 : 0);
}

layout::SplitTriangle splitTriangle(const Skin& skin, const NetworkSkins::Offsets& offsets, uint32_t t) {
  layout::SplitTriangle out{};
  out.triangle = offsets.triangle + t;
  for (size_t i = 0; i < 3; ++i) {
    const uint32_t corner = skin.mesh.triangles[t][i], e = skin.triangle_edges[t][i];
    out.slots[i] = offsets.slot + skin.bindings[corner].slot0;
    out.springs[i] = layout::kNoSpring;
    if (e == kNoSplitEdge) continue;
    const bool backwards = skin.split_edges[e].a != corner;
    out.springs[i] = offsets.spring + skin.split_edges[e].spring;
    out.vertices[2 * i] = splitVertex(skin, offsets, e, backwards);
    out.vertices[2 * i + 1] = splitVertex(skin, offsets, e, !backwards);
  }
  return out;
}

}  // namespace

bool isOneToOne(const Body& body) {
  return !body.hasCells();
}

void NetworkSkins::append(const Body& body, const Offsets& offsets) {
  const auto first_ring_vertex = static_cast<uint32_t>(vertices.size());
  appendRings(body.skin, offsets);
  if (!body.skin.split_edges.empty()) appendSplits(body.skin, offsets, first_ring_vertex);
}

void NetworkSkins::appendRings(const Skin& skin, const Offsets& offsets) {
  const auto first = static_cast<uint32_t>(rings.size());
  const std::vector<uint32_t> starts = ringStarts(skin.mesh);
  for (uint32_t v = 0; v < skin.bindings.size(); ++v) {
    const layout::SkinBinding& binding = skin.bindings[v];
    vertices.push_back({offsets.vertex + v, offsets.slot + binding.slot0, first + starts[v], first + starts[v + 1],
                        binding.normal_constant});
  }
  std::vector<uint32_t> next(starts.begin(), starts.end() - 1);
  rings.resize(first + starts.back());
  const auto slot = [&](uint32_t vertex) { return offsets.slot + skin.bindings[vertex].slot0; };
  for (uint32_t t = 0; t < skin.mesh.triangles.size(); ++t) {
    const std::array<uint32_t, 3>& corners = skin.mesh.triangles[t];
    for (size_t i = 0; i < 3; ++i) {
      rings[first + next[corners[i]]++] = {slot(corners[(i + 1) % 3]), slot(corners[(i + 2) % 3]), offsets.triangle + t,
                                           0};
    }
  }
}

void NetworkSkins::appendSplits(const Skin& skin, const Offsets& offsets, uint32_t first_ring_vertex) {
  for (uint32_t e = 0; e < skin.split_edges.size(); ++e) {
    const SplitEdge& edge = skin.split_edges[e];
    edges.push_back({first_ring_vertex + edge.a, first_ring_vertex + edge.b, offsets.spring + edge.spring,
                     splitVertex(skin, offsets, e, false)});
  }
  for (uint32_t t = 0; t < skin.triangle_edges.size(); ++t) triangles.push_back(splitTriangle(skin, offsets, t));
}

void JoinedSkins::append(const Body& body, const NetworkSkins::Offsets& offsets, MovedNormals normals) {
  const Skin& skin = body.skin;
  if (isOneToOne(body)) {
    any_one_to_one = true;
    networks.append(body, offsets);
  } else {
    any_bound = true;
    appendNormalNodes(body, offsets.slot, normals);
  }
  appendBindings(skin, offsets.slot);
  appendTriangles(skin, offsets);
  appendRests(skin);
  appendCharts(skin, offsets);
  const std::vector<uint32_t> own_colors = vertexColors(skin.mesh, body.color, skin.two_sided, bodies_++);
  colors.insert(colors.end(), own_colors.begin(), own_colors.end());
  for (const SplitEdge& edge : skin.split_edges) {
    colors.push_back(own_colors[edge.a]);
    colors.push_back(own_colors[edge.b]);
  }
}

void JoinedSkins::appendBindings(const Skin& skin, uint32_t slot_offset) {
  for (layout::SkinBinding binding : skin.bindings) {
    binding.slot0 += slot_offset;
    binding.slot1 += slot_offset;
    binding.slot2 += slot_offset;
    bindings.push_back(binding);
  }
  for (const SplitEdge& edge : skin.split_edges) {  // no kernel of lattices reads these
    for (const uint32_t end : {edge.a, edge.b}) {
      layout::SkinBinding split{};
      split.slot0 = slot_offset + skin.bindings[end].slot0;
      split.springs = layout::kOneToOneBit;
      split.weights.x = 1;
      bindings.push_back(split);
    }
  }
}

void JoinedSkins::appendNormalNodes(const Body& body, uint32_t slot_offset, MovedNormals normals) {
  std::vector<uint32_t> slots;
  bool summed = normals == MovedNormals::kSummed;
  for (const layout::SkinBinding& b : body.skin.bindings) {
    kinds |= b.springs;
    summed = summed || (b.springs & (layout::kAlongNormalBit | layout::kOneNodeBit)) != 0;
    if (b.springs & (layout::kInterpolatedBit | layout::kAlongNormalBit | layout::kOneNodeBit))
      slots.push_back(b.slot0);
    if (b.springs & (layout::kInterpolatedBit | layout::kAlongNormalBit)) slots.insert(slots.end(), {b.slot1, b.slot2});
  }
  std::sort(slots.begin(), slots.end());
  slots.erase(std::unique(slots.begin(), slots.end()), slots.end());
  for (const uint32_t slot : slots) {
    const Vector3f normal = neighborSum(body.lattice, slot).stableNormalized().cast<float>();
    (summed ? summed_nodes : carried_nodes).push_back({slot + slot_offset, normal.x(), normal.y(), normal.z()});
  }
}

void JoinedSkins::appendTriangles(const Skin& skin, const NetworkSkins::Offsets& offsets) {
  for (const auto& corners : skin.mesh.triangles) {
    for (const uint32_t v : corners) triangles.push_back(v + offsets.vertex);
  }
}

/// Appends rest positions. Vertices of a split edge begin at its middle.
void JoinedSkins::appendRests(const Skin& skin) {
  const auto add = [&](const Vector3f& at) { rests.push_back({at.x(), at.y(), at.z(), 0}); };
  for (const Vector3f& at : skin.mesh.positions_m) add(at);
  for (const SplitEdge& edge : skin.split_edges) {
    const Vector3f middle = 0.5F * (skin.mesh.positions_m[edge.a] + skin.mesh.positions_m[edge.b]);
    add(middle);
    add(middle);
  }
}

void JoinedSkins::appendCharts(const Skin& skin, const NetworkSkins::Offsets& offsets) {
  const size_t all = offsets.triangle + skin.mesh.triangles.size();
  if (!skin.mesh.charts.empty()) {
    charts.resize(offsets.triangle, kNoChart);  // of the bodies before, which have none
    for (const uint32_t chart : skin.mesh.charts) charts.push_back(chart == kNoChart ? chart : chart + charts_before_);
  } else if (!charts.empty()) {
    charts.resize(all, kNoChart);
  }
  if (skin.mesh.detail) charts_before_ += static_cast<uint32_t>(skin.mesh.detail->charts.size());
}

JoinedSkins joinSkins(const Model& model, MovedNormals normals) {
  JoinedSkins joined;
  uint32_t springs = 0;
  for (size_t b = 0; b < model.bodies.size(); ++b) {
    const Body& body = model.bodies[b];
    const auto vertices = static_cast<uint32_t>(joined.bindings.size());
    const auto triangles = static_cast<uint32_t>(joined.triangles.size() / 3);
    joined.append(body, {model.slotOffset(b), vertices, triangles, springs}, normals);
    if (body.network) springs += static_cast<uint32_t>(body.network->springs.size());
  }
  return joined;
}

std::vector<uint32_t> splitsOf(const JoinedSkins& skins) {
  std::vector<uint32_t> out;
  if (!skins.networks.triangles.empty()) out.assign(2 * skins.triangles.size(), 0);
  for (const layout::SplitTriangle& t : skins.networks.triangles) {
    std::copy(std::begin(t.vertices), std::end(t.vertices), out.begin() + 6 * size_t{t.triangle});
  }
  return out;
}

std::vector<uint32_t> shownBricks(const Model& model) {
  std::vector<bool> shown(model.slots() / layout::kBrickSlots);
  for (size_t b = 0; b < model.bodies.size(); ++b) {
    const Lattice& lattice = model.bodies[b].lattice;
    const size_t first = model.slotOffset(b) / layout::kBrickSlots;
    if (model.bodies[b].skin.can_be_cut)
      std::fill_n(shown.begin() + static_cast<ptrdiff_t>(first), lattice.bricks.size(), true);
    for (uint32_t slot : model.bodies[b].skin.bound_slots) {
      shown[first + slot / layout::kBrickSlots] = true;
      for (uint32_t spring = 0; spring < layout::kSpringsPerNode; ++spring) {
        const int64_t neighbor = lattice.neighborSlot(slot, spring);
        if (neighbor >= 0) shown[first + static_cast<size_t>(neighbor) / layout::kBrickSlots] = true;
      }
    }
  }
  std::vector<uint32_t> out;
  for (uint32_t brick = 0; brick < shown.size(); ++brick) {
    if (shown[brick]) out.push_back(brick);
  }
  return out;
}

}  // namespace viscera
