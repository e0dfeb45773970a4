// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include "layout/network_skin.h"
#include "viscera/gpu/buffer.h"
#include "viscera/gpu/program.h"
#include "viscera/model/model.h"
#include "viscera/solver/state.h"

namespace viscera {

/// The skin of a body is its network's: a vertex is a node (EGVE 3.2).
bool isOneToOne(const Body& body);

/// The skins of all networks of a model as one, numbered through as the vertices and triangles of Surface are.
struct NetworkSkins {
  std::vector<layout::RingVertex> vertices;
  std::vector<layout::RingTriangle> rings;
  std::vector<layout::SplitEdge> edges;
  std::vector<layout::SplitTriangle> triangles;  ///< of bodies that can be cut

  /// Where the buffers of Surface begin for the body. Its split vertices follow its own.
  struct Place {
    uint32_t slot = 0, vertex = 0, triangle = 0, spring = 0;
  };
  void append(const Body& body, const Place& place);

 private:
  void appendRings(const Skin& skin, const Place& place);
  void appendSplits(const Skin& skin, const Place& place, uint32_t first_ring_vertex);
};

/// What Surface does for networks. Owner of shaders/surface/network_skin.comp, split_edges.comp,
/// crossed_edges.comp and split_triangles.comp.
class NetworkSurface {
 public:
  /// Needs a current context. @throws GpuError
  explicit NetworkSurface(const NetworkSkins& skins);

  /// Vertices and normals of the networks, and the split vertices if they can be seen. Positions, normals and the
  /// state of triangles are bound by Surface.
  /// @param since  what moved no later is in place; 0: nothing is
  void follow(const StateView& state, uint32_t since);
  /// What is shown of each triangle. @param triangles  of all bodies
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
  bool placed_ = false;  ///< split vertices of whole edges are
};

}  // namespace viscera
