// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "surface/network_surface.h"

#include <cassert>
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

}  // namespace

NetworkSurface::NetworkSurface(const NetworkSkins& skins)
    : vertices_(skins.vertices),
      rings_(skins.rings),
      edges_(skins.edges),
      triangles_(skins.triangles),
      follow_(kernel("network_skin.comp")) {
  if (skins.edges.empty()) return;
  crossed_ = gpu::Buffer<uint32_t>(4 + edges_.size(), "crossed");
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
  assert(state.spring_cut != 0 && state.rest != 0);
  bind(layout::kBindRest, state.rest);
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
