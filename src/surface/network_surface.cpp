// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "surface/network_surface.h"

#include <cassert>
#include <string>

#include "gpu/gl.h"
#include "layout/bindings.h"
#include "layout/network_skin.h"
#include "surface/surface_kernels.h"

namespace viscera {
namespace {

gpu::Program networkKernel(const std::string& name) {
  return surfaceKernel(name, {"NETWORK"});
}

}  // namespace

NetworkSurface::NetworkSurface(const NetworkSkins& skins)
    : vertices_(skins.vertices),
      rings_(skins.rings),
      edges_(skins.edges),
      triangles_(skins.triangles),
      follow_(networkKernel("network_skin.comp")) {
  if (skins.edges.empty()) return;
  crossed_ = gpu::Buffer<uint32_t>(4 + edges_.size(), "crossed");
  list_crossed_ = networkKernel("crossed_edges.comp");
  split_edges_ = networkKernel("split_edges.comp");
  split_triangles_ = networkKernel("split_triangles.comp");
}

void NetworkSurface::follow(const StateView& state, uint32_t since) {
  assert(state.rest != 0);
  bindStorage(layout::kBindRest, state.rest);
  vertices_.bindStorage(layout::kBindRingVertices);
  rings_.bindStorage(layout::kBindRings);
  follow_.set("followed_revision", since);
  runOver(follow_, vertices_.size());
  if (edges_.size() > 0 && (torn_ || !placed_)) placeSplits(state, since);
}

void NetworkSurface::placeSplits(const StateView& state, uint32_t since) {
  assert(state.spring_cut != 0);
  gpu::Program::storageBarrier();
  bindStorage(layout::kBindSpringCut, state.spring_cut);
  edges_.bindStorage(layout::kBindSplitEdges);
  crossed_.bindStorage(layout::kBindCrossedEdges);
  split_edges_.set("followed_revision", placed_ ? since : 0u);
  split_edges_.set("placed", placed_ ? 1u : 0u);
  if (placed_) {
    split_edges_.use();
    glBindBuffer(GL_DISPATCH_INDIRECT_BUFFER, crossed_.id());
    glDispatchComputeIndirect(0);
  } else {
    runOver(split_edges_, edges_.size());
  }
  placed_ = true;
}

void NetworkSurface::split(const StateView& state, size_t triangles) {
  if (triangles_.size() == 0) return;
  assert(state.spring_cut != 0 && state.rest != 0);
  bindStorage(layout::kBindRest, state.rest);
  bindStorage(layout::kBindSpringCut, state.spring_cut);
  triangles_.bindStorage(layout::kBindSplitTriangles);
  split_triangles_.set("triangle_count", static_cast<uint32_t>(triangles));
  runOver(split_triangles_, triangles_.size());
  edges_.bindStorage(layout::kBindSplitEdges);
  crossed_.bindStorage(layout::kBindCrossedEdges);
  crossed_.write({0, 1, 1, 0});
  runOver(list_crossed_, edges_.size());
  glMemoryBarrier(GL_COMMAND_BARRIER_BIT);
  torn_ = true;
}

}  // namespace viscera
