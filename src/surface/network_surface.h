// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

#include "gpu/buffer.h"
#include "gpu/program.h"
#include "layout/network_skin.h"
#include "surface/skins/joined_skins.h"
#include "viscera/solver/state.h"

namespace viscera {

/// The part of Surface for networks. Owner of shaders/surface/network_skin.comp, split_edges.comp, crossed_edges.comp
/// and split_triangles.comp.
class NetworkSurface {
 public:
  /// Needs a current context. @throws GpuError
  explicit NetworkSurface(const NetworkSkins& skins);

  /// Updates vertices and normals of the networks, and the split vertices if they can be seen. Surface binds positions,
  /// normals and the state of triangles.
  /// @param since  revision: what has not moved after it is up to date; 0: nothing is
  void follow(const StateView& state, uint32_t since);
  /// Computes which pieces of each triangle are shown. @param triangles  of all bodies
  void split(const StateView& state, size_t triangles);
  void reset() { torn_ = placed_ = false; }

 private:
  void placeSplits(const StateView& state, uint32_t since);

  gpu::Buffer<layout::RingVertex> vertices_;
  gpu::Buffer<layout::RingTriangle> rings_;
  gpu::Buffer<layout::SplitEdge> edges_;
  gpu::Buffer<layout::SplitTriangle> triangles_;
  gpu::Buffer<uint32_t> crossed_;  ///< see kBindCrossedEdges
  gpu::Program follow_, list_crossed_, split_edges_, split_triangles_;
  bool torn_ = false;    ///< some triangle may be split
  bool placed_ = false;  ///< split vertices of whole edges are placed
};

}  // namespace viscera
