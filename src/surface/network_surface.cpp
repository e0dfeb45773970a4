// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "surface/network_surface.h"

#include <array>
#include <cassert>
#include <numeric>
#include <string>

#include "gpu/gl.h"
#include "layout/bindings.h"
#include "layout/network_skin.h"

namespace viscera {
namespace {

gpu::Program kernel(const std::string& name) {
  return gpu::Program::compute(name, {"GROUP_SIZE " + std::to_string(layout::kGroupSize), "NETWORK"});
}

void bind(uint32_t binding, uint32_t buffer) {
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, binding, buffer);
}

void run(const gpu::Program& kernel, size_t count) {
  kernel.set("count", static_cast<uint32_t>(count));
  kernel.use();
  gpu::Program::dispatch(count, layout::kGroupSize);
}

/// Of each vertex: where its ring begins; [vertices + 1].
std::vector<uint32_t> ringStarts(const TriangleMesh& mesh) {
  std::vector<uint32_t> starts(mesh.positions_m.size() + 1);
  for (const auto& triangle : mesh.triangles) {
    for (uint32_t vertex : triangle) ++starts[vertex + 1];
  }
  std::partial_sum(starts.begin(), starts.end(), starts.begin());
  return starts;
}

/// The vertex that a split edge has at its end a, or b, follows the body's own vertices.
uint32_t splitVertex(const Skin& skin, const NetworkSkins::Place& place, uint32_t edge, bool at_b) {
  return place.vertex + static_cast<uint32_t>(skin.bindings.size()) + 2 * edge + (at_b ? 1 : 0);
}

layout::SplitTriangle splitTriangle(const Skin& skin, const NetworkSkins::Place& place, uint32_t t) {
  layout::SplitTriangle out{};
  out.triangle = place.triangle + t;
  for (size_t i = 0; i < 3; ++i) {
    const uint32_t corner = skin.mesh.triangles[t][i], e = skin.triangle_edges[t][i];
    out.slots[i] = place.slot + skin.bindings[corner].slot0;
    out.springs[i] = layout::kNoSpring;
    if (e == kNoSplitEdge) continue;
    const bool backwards = skin.split_edges[e].a != corner;
    out.springs[i] = place.spring + skin.split_edges[e].spring;
    out.vertices[2 * i] = splitVertex(skin, place, e, backwards);
    out.vertices[2 * i + 1] = splitVertex(skin, place, e, !backwards);
  }
  return out;
}

}  // namespace

bool isOneToOne(const Body& body) {
  return body.network && !body.network->of_lattice;
}

void NetworkSkins::append(const Body& body, const Place& place) {
  const auto first_ring_vertex = static_cast<uint32_t>(vertices.size());
  appendRings(body.skin, place);
  if (!body.skin.split_edges.empty()) appendSplits(body.skin, place, first_ring_vertex);
}

void NetworkSkins::appendRings(const Skin& skin, const Place& place) {
  const auto first = static_cast<uint32_t>(rings.size());
  const std::vector<uint32_t> starts = ringStarts(skin.mesh);
  for (uint32_t v = 0; v < skin.bindings.size(); ++v) {
    const layout::SkinBinding& binding = skin.bindings[v];
    vertices.push_back({place.vertex + v, place.slot + binding.slot0, first + starts[v], first + starts[v + 1],
                        binding.normal_constant});
  }
  std::vector<uint32_t> next(starts.begin(), starts.end() - 1);
  rings.resize(first + starts.back());
  const auto slot = [&](uint32_t vertex) { return place.slot + skin.bindings[vertex].slot0; };
  for (uint32_t t = 0; t < skin.mesh.triangles.size(); ++t) {
    const std::array<uint32_t, 3>& corners = skin.mesh.triangles[t];
    for (size_t i = 0; i < 3; ++i) {
      rings[first + next[corners[i]]++] = {slot(corners[(i + 1) % 3]), slot(corners[(i + 2) % 3]), place.triangle + t,
                                           0};
    }
  }
}

void NetworkSkins::appendSplits(const Skin& skin, const Place& place, uint32_t first_ring_vertex) {
  for (uint32_t e = 0; e < skin.split_edges.size(); ++e) {
    const SplitEdge& edge = skin.split_edges[e];
    edges.push_back({first_ring_vertex + edge.a, first_ring_vertex + edge.b, place.spring + edge.spring,
                     splitVertex(skin, place, e, false)});
  }
  for (uint32_t t = 0; t < skin.triangle_edges.size(); ++t) triangles.push_back(splitTriangle(skin, place, t));
}

NetworkSurface::NetworkSurface(const NetworkSkins& skins)
    : vertices_(skins.vertices),
      rings_(skins.rings),
      edges_(skins.edges),
      triangles_(skins.triangles),
      follow_(kernel("network_skin.comp")) {
  if (skins.edges.empty()) return;
  crossed_ = gpu::Buffer<uint32_t>(4 + edges_.size());
  list_crossed_ = kernel("crossed_edges.comp");
  split_edges_ = kernel("split_edges.comp");
  split_triangles_ = kernel("split_triangles.comp");
}

void NetworkSurface::follow(const StateView& state, uint32_t since) {
  assert(state.rest != 0);
  bind(layout::kBindRest, state.rest);
  vertices_.bindStorage(layout::kBindRingVertices);
  rings_.bindStorage(layout::kBindRings);
  follow_.set("followed_revision", since);
  run(follow_, vertices_.size());
  if (edges_.size() > 0 && (torn_ || !placed_)) placeSplits(state, since);
}

void NetworkSurface::placeSplits(const StateView& state, uint32_t since) {
  assert(state.spring_cut != 0);
  gpu::Program::storageBarrier();
  bind(layout::kBindSpringCut, state.spring_cut);
  edges_.bindStorage(layout::kBindSplitEdges);
  crossed_.bindStorage(layout::kBindCrossedEdges);
  split_edges_.set("followed_revision", placed_ ? since : 0u);
  split_edges_.set("placed", placed_ ? 1u : 0u);
  if (placed_) {
    split_edges_.use();
    glBindBuffer(GL_DISPATCH_INDIRECT_BUFFER, crossed_.id());
    glDispatchComputeIndirect(0);
  } else {
    run(split_edges_, edges_.size());
  }
  placed_ = true;
}

void NetworkSurface::split(const StateView& state, size_t triangles) {
  if (triangles_.size() == 0) return;
  assert(state.spring_cut != 0);
  bind(layout::kBindSpringCut, state.spring_cut);
  triangles_.bindStorage(layout::kBindSplitTriangles);
  split_triangles_.set("triangle_count", static_cast<uint32_t>(triangles));
  run(split_triangles_, triangles_.size());
  edges_.bindStorage(layout::kBindSplitEdges);
  crossed_.bindStorage(layout::kBindCrossedEdges);
  crossed_.write({0, 1, 1, 0});
  run(list_crossed_, edges_.size());
  glMemoryBarrier(GL_COMMAND_BARRIER_BIT);
  torn_ = true;
}

}  // namespace viscera
