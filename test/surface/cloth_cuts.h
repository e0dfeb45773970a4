// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Cuts of networks as the solvers leave them, and the mesh that is then drawn.
#pragma once

#include <algorithm>
#include <array>
#include <map>
#include <numeric>
#include <set>
#include <vector>

#include "math/union_find.h"
#include "support/networks.h"
#include "surface/surface_rig.h"

namespace viscera::testing {

/// Returns the number of springs in the networks of the bodies before this one: its first in SurfaceRig::spring_cut.
inline size_t firstSpring(const Model& model, size_t body) {
  size_t first = 0;
  for (size_t b = 0; b < body; ++b) first += model.bodies[b].network ? model.bodies[b].network->springs.size() : 0;
  return first;
}

/// Removes a spring of a body's network from both ends, crossed at a share of its length from a to b.
inline void cutSpring(SurfaceRig& rig, size_t body, size_t spring, double share) {
  float& cut = rig.spring_cut[firstSpring(rig.model, body) + spring];
  if (cut != 0) return;
  cut = static_cast<float>(share);
  const NetworkSpring& ends = rig.model.bodies[body].network->springs[spring];
  for (uint32_t slot : {ends.a, ends.b}) --rig.nodes[rig.model.slotOffset(body) + slot].lo;  // the valence
}

inline size_t springBetween(const SpringNetwork& network, uint32_t a, uint32_t b) {
  const auto its = std::find_if(network.springs.begin(), network.springs.end(), [&](const NetworkSpring& spring) {
    return spring.a == std::min(a, b) && spring.b == std::max(a, b);
  });
  return static_cast<size_t>(its - network.springs.begin());
}

/// Cuts every spring that crosses the plane in which `height` of a rest position is 0.
template <class Height>
void cutThrough(SurfaceRig& rig, size_t body, Height height) {
  const SpringNetwork& network = *rig.model.bodies[body].network;
  for (size_t i = 0; i < network.springs.size(); ++i) {
    const double a = height(network.positions_m[network.springs[i].a]);
    const double b = height(network.positions_m[network.springs[i].b]);
    if ((a < 0) != (b < 0)) cutSpring(rig, body, i, a / (a - b));
  }
}

using Corners = std::array<uint32_t, 3>;

inline std::vector<Corners> drawnTriangles(const Surface& surface) {
  const std::vector<uint32_t> live = surface.liveIndices().read();
  std::vector<Corners> out;
  for (size_t i = 0; i < live.size(); i += 3) {
    if (live[i] != live[i + 1]) out.push_back({live[i], live[i + 1], live[i + 2]});
  }
  return out;
}

inline double areaOf(const std::vector<Corners>& triangles, const std::vector<Vector3d>& at) {
  return std::accumulate(triangles.begin(), triangles.end(), 0.0, [&](double sum, const Corners& t) {
    return sum + 0.5 * (at[t[1]] - at[t[0]]).cross(at[t[2]] - at[t[0]]).norm();
  });
}

/// Returns the pieces connected by shared vertices: for each vertex that is drawn, the lowest vertex of its piece.
inline std::map<uint32_t, uint32_t> drawnPieces(const std::vector<Corners>& triangles) {
  uint32_t most = 0;
  for (const Corners& t : triangles) most = std::max({most, t[0], t[1], t[2]});
  UnionFind pieces(size_t{most} + 1);
  for (const Corners& t : triangles) {
    pieces.unite(t[0], t[1]);
    pieces.unite(t[0], t[2]);
  }
  std::map<uint32_t, uint32_t> lowest;
  for (const Corners& t : triangles) {
    for (uint32_t v : t) lowest[v] = pieces.find(v);
  }
  return lowest;
}

inline size_t countPieces(const std::vector<Corners>& triangles) {
  std::set<uint32_t> roots;
  for (const auto& [v, root] : drawnPieces(triangles)) roots.insert(root);
  return roots.size();
}

}  // namespace viscera::testing
