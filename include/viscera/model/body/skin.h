// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "viscera/api.h"
#include "viscera/layout/skin.h"
#include "viscera/model/body/lattice.h"
#include "viscera/model/shape/triangle_mesh.h"

namespace VISCERA_PUBLIC viscera {

/// Edge of a network's surface mesh that splits where a blade crosses its spring.
struct SplitEdge {
  uint32_t a = 0, b = 0;  ///< vertices, a < b, in the order of the spring's ends
  uint32_t spring = 0;    ///< index into the network's springs
};
constexpr uint32_t kNoSplitEdge = UINT32_MAX;

/// Detailed surface mesh of a body, bound to its lattice (EGVE 3.3) or node by node to its network (network_skin.h).
/// Slots are those of the body.
struct Skin {
  TriangleMesh mesh;                          ///< mesh in the rest pose [m], tissue frame
  std::vector<layout::SkinBinding> bindings;  ///< [vertices]
  std::vector<uint32_t> bound_slots;          ///< slots with a vertex bound to them, ascending
  std::vector<SplitEdge> split_edges;         ///< edges of a network that can be cut
  /// [triangles] split edges 01, 12, 20, or kNoSplitEdge; empty unless the body is a network that can be cut
  std::vector<std::array<uint32_t, 3>> triangle_edges;
  bool can_be_cut = false;   ///< a tool of the scene can cut it: data for wounds is prepared (surface/wounds/wounds.h)
  bool two_sided = false;    ///< a sheet with borders: its back is not the inside of a body
  size_t deep_vertices = 0;  ///< number of vertices bound inside the body because they are too far from its boundary
  size_t constant_vertices = 0;  ///< number of vertices with the constant mapping in place of the requested one
  size_t bridges_removed = 0;  ///< number of triangles left out because they join pieces of tissue that no spring joins
};

/// Binds every vertex to the nearest triangle of the lattice's boundary (EGVE 3.3.1). The reference point is the
/// closest point, so weights are 0..1. A vertex deeper than one cell, for example where parts of an organ meet, is
/// bound to a face of its own cell. It then moves and is cut with the tissue around it.
///
/// In a lattice with partly filled cells every vertex is bound to a face of its own cell. While no spring of the cell's
/// corners is cut, the eight corners carry it: boundary faces are outside the tissue there, on light and soft nodes.
///
/// Edges longer than the spacing are split first, so that a cut can open between any two lattice nodes. Triangles that
/// join nodes without a path of springs between them are left out.
///
/// This describes Mapping::kAuto. The other mappings (docs/surface.md) bind to the boundary everywhere, and to a
/// cell's face where a vertex is deep.
/// @param solid  the solid that `lattice` was built from
Skin bindSkin(const TriangleMesh& mesh, const Lattice& lattice, const Solid& solid, Mapping mapping = Mapping::kAuto,
              const Progress& progress = {});

}  // namespace viscera
