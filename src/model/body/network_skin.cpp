// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "model/body/network_skin.h"

#include <algorithm>
#include <map>
#include <utility>

namespace viscera {
namespace {

using Edge = std::pair<uint32_t, uint32_t>;  ///< lower end first

Edge edgeOf(const std::array<uint32_t, 3>& triangle, size_t corner) {
  return std::minmax(triangle[corner], triangle[(corner + 1) % 3]);
}

std::vector<uint32_t> surfaceSlots(const SpringNetwork& network) {
  std::vector<uint32_t> slots;
  for (const auto& triangle : network.triangles) slots.insert(slots.end(), triangle.begin(), triangle.end());
  std::sort(slots.begin(), slots.end());
  slots.erase(std::unique(slots.begin(), slots.end()), slots.end());
  return slots;
}

TriangleMesh meshOf(const SpringNetwork& network, const std::vector<uint32_t>& slots) {
  std::vector<uint32_t> vertex_of(network.positions_m.size());
  TriangleMesh mesh;
  for (const uint32_t slot : slots) {
    vertex_of[slot] = static_cast<uint32_t>(mesh.positions_m.size());
    mesh.positions_m.push_back(network.positions_m[slot].cast<float>());
  }
  for (const auto& t : network.triangles) mesh.triangles.push_back({vertex_of[t[0]], vertex_of[t[1]], vertex_of[t[2]]});
  mesh.parts.assign(mesh.triangles.size(), 0);
  mesh.part_names = {"surface"};
  mesh.charts = network.charts;
  mesh.detail = network.detail;
  return mesh;
}

layout::SkinBinding oneToOne(uint32_t slot, const Vector3f& normal) {
  layout::SkinBinding binding{};
  binding.slot0 = binding.slot1 = binding.slot2 = slot;
  binding.springs = layout::kOneToOneBit;
  binding.weights = {1, 0, 0, 0};
  binding.normal_constant = {normal.x(), normal.y(), normal.z(), 0};
  return binding;
}

/// Returns whether some edge has only one triangle.
bool hasBorder(const TriangleMesh& mesh) {
  std::vector<Edge> edges;
  for (const auto& triangle : mesh.triangles) {
    for (size_t corner = 0; corner < 3; ++corner) edges.push_back(edgeOf(triangle, corner));
  }
  std::sort(edges.begin(), edges.end());
  for (auto edge = edges.begin(); edge != edges.end();) {
    const auto next = std::upper_bound(edge, edges.end(), *edge);
    if (next - edge == 1) return true;
    edge = next;
  }
  return false;
}

/// Adds a split edge. Springs are ordered by their ends, and vertices by their slots.
/// @return index of the new split edge, or kNoSplitEdge where no spring joins the ends
uint32_t addSplitEdge(const SpringNetwork& network, const Edge& edge, Skin& skin) {
  const auto before = [](const NetworkSpring& spring, const Edge& ends) { return Edge(spring.a, spring.b) < ends; };
  const Edge ends(skin.bound_slots[edge.first], skin.bound_slots[edge.second]);
  const auto spring = std::lower_bound(network.springs.begin(), network.springs.end(), ends, before);
  if (spring == network.springs.end() || Edge(spring->a, spring->b) != ends) return kNoSplitEdge;
  skin.split_edges.push_back({edge.first, edge.second, static_cast<uint32_t>(spring - network.springs.begin())});
  return static_cast<uint32_t>(skin.split_edges.size() - 1);
}

void addSplitEdges(const SpringNetwork& network, Skin& skin) {
  std::map<Edge, uint32_t> known;
  for (const auto& triangle : skin.mesh.triangles) {
    std::array<uint32_t, 3> edges{};
    for (size_t corner = 0; corner < 3; ++corner) {
      const Edge edge = edgeOf(triangle, corner);
      const auto entry = known.find(edge);
      edges[corner] =
          entry != known.end() ? entry->second : known.emplace(edge, addSplitEdge(network, edge, skin)).first->second;
    }
    skin.triangle_edges.push_back(edges);
  }
}

}  // namespace

Skin bindNetworkSkin(const SpringNetwork& network, bool can_be_cut) {
  Skin skin;
  skin.bound_slots = surfaceSlots(network);
  skin.mesh = meshOf(network, skin.bound_slots);
  const std::vector<Vector3f> normals = vertexNormals(skin.mesh);
  for (size_t v = 0; v < normals.size(); ++v) skin.bindings.push_back(oneToOne(skin.bound_slots[v], normals[v]));
  skin.two_sided = hasBorder(skin.mesh);
  if (can_be_cut) addSplitEdges(network, skin);
  return skin;
}

}  // namespace viscera
