// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "surface/wounds/tetrahedra_index.h"

#include <algorithm>
#include <cassert>
#include <numeric>
#include <utility>

#include "model/shape/mesh/triangle_tree.h"
#include "surface/wounds/tetrahedron_walls.h"

namespace viscera {

namespace {

using Slots = std::array<uint32_t, 3>;

uint32_t springBetween(const SpringNetwork& network, uint32_t a, uint32_t b) {
  const std::pair<uint32_t, uint32_t> ends = std::minmax(a, b);
  const auto before = [](const NetworkSpring& spring, const std::pair<uint32_t, uint32_t>& of) {
    return std::make_pair(spring.a, spring.b) < of;
  };
  const auto at = std::lower_bound(network.springs.begin(), network.springs.end(), ends, before);
  assert(at != network.springs.end() && at->a == ends.first && at->b == ends.second);
  return static_cast<uint32_t>(at - network.springs.begin());
}

/// @param keys_of(i)  keys under which item i of `count` is found
template <class KeysOf>
ItemRuns runsOf(size_t keys, size_t count, KeysOf keys_of) {
  ItemRuns out;
  out.starts.assign(keys + 1, 0);
  for (size_t i = 0; i < count; ++i)
    for (const uint32_t key : keys_of(i)) ++out.starts[key + 1];
  std::partial_sum(out.starts.begin(), out.starts.end(), out.starts.begin());
  out.items.resize(out.starts.back());
  std::vector<uint32_t> next(out.starts.begin(), out.starts.end() - 1);
  for (size_t i = 0; i < count; ++i)
    for (const uint32_t key : keys_of(i)) out.items[next[key]++] = static_cast<uint32_t>(i);
  return out;
}

Slots sorted(Slots slots) {
  std::sort(slots.begin(), slots.end());
  return slots;
}

}  // namespace

TetrahedraIndex::TetrahedraIndex(const SpringNetwork& network, const Skin& skin) {
  for (const std::array<uint32_t, 4>& slots : network.tetrahedra) {
    Tetrahedron t{slots, {}, {}};
    for (size_t e = 0; e < 6; ++e) {
      const auto [a, b] = kTetrahedronEdges[e];
      t.springs[e] = springBetween(network, slots[a], slots[b]);
    }
    tetrahedra.push_back(t);
  }
  vertex_of_slot.assign(network.positions_m.size(), kNone);
  for (uint32_t v = 0; v < skin.bindings.size(); ++v) vertex_of_slot[skin.bindings[v].slot0] = v;
  for (const Slots& t : network.triangles)
    triangle_springs.push_back(
        {springBetween(network, t[0], t[1]), springBetween(network, t[1], t[2]), springBetween(network, t[2], t[0])});
  findFaces(skin);
  findDepths(network, skin);
  of_spring = runsOf(network.springs.size(), tetrahedra.size(),
                     [&](size_t t) -> const std::array<uint32_t, 6>& { return tetrahedra[t].springs; });
  of_slot = runsOf(network.positions_m.size(), tetrahedra.size(),
                   [&](size_t t) -> const std::array<uint32_t, 4>& { return tetrahedra[t].slots; });
}

void TetrahedraIndex::findFaces(const Skin& skin) {
  struct Seen {
    Slots slots;
    uint32_t tetrahedron, face;
    bool operator<(const Seen& other) const { return slots < other.slots; }
  };
  std::vector<Seen> seen;
  for (uint32_t t = 0; t < tetrahedra.size(); ++t) {
    const std::array<uint32_t, 4>& slots = tetrahedra[t].slots;
    for (uint32_t f = 0; f < 4; ++f) {
      const auto& c = kTetrahedronFaces[f];
      seen.push_back({sorted({slots[c[0]], slots[c[1]], slots[c[2]]}), t, f});
    }
  }
  std::stable_sort(seen.begin(), seen.end());
  for (const Seen& s : seen) {
    if (faces.empty() || faces.back().slots != s.slots) faces.push_back({s.slots, kNone});
    tetrahedra[s.tetrahedron].faces[s.face] = static_cast<uint32_t>(faces.size() - 1);
  }
  for (uint32_t t = 0; t < skin.mesh.triangles.size(); ++t) {
    Slots slots{};
    for (size_t i = 0; i < 3; ++i) slots[i] = skin.bindings[skin.mesh.triangles[t][i]].slot0;
    slots = sorted(slots);
    const auto before = [](const Face& face, const Slots& of) { return face.slots < of; };
    const auto face = std::lower_bound(faces.begin(), faces.end(), slots, before);
    assert(face != faces.end() && face->slots == slots);
    face->triangle = t;
    triangle_faces.push_back(static_cast<uint32_t>(face - faces.begin()));
  }
}

void TetrahedraIndex::findDepths(const SpringNetwork& network, const Skin& skin) {
  const TriangleTree tree(skin.mesh);
  depth_m.assign(network.positions_m.size(), 0);
  for (uint32_t slot = 0; slot < depth_m.size(); ++slot) {
    if (vertex_of_slot[slot] != kNone || !(network.masses_kg[slot] > 0)) continue;
    const MeshPlace nearest = tree.nearest(network.positions_m[slot].cast<float>());
    if (nearest.found()) depth_m[slot] = nearest.distance_m;
  }
}

}  // namespace viscera
