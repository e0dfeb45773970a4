// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "viscera/layout/skin.h"
#include "viscera/model/body/lattice.h"
#include "viscera/model/shape/triangle_mesh.h"

namespace viscera {

/// An edge of a network's surface that splits where a blade crosses its spring.
struct SplitEdge {
  uint32_t a = 0, b = 0;  ///< vertices, a < b, in the order of the spring's ends
  uint32_t spring = 0;    ///< index into the network's springs
};
constexpr uint32_t kNoSplitEdge = UINT32_MAX;

/// The detailed surface of a body, bound to its lattice (EGVE 3.3) or node by node to its network (network_skin.h).
/// Slots are those of the body.
struct Skin {
  TriangleMesh mesh;                          ///< rest pose [m], tissue frame
  std::vector<layout::SkinBinding> bindings;  ///< [vertices]
  std::vector<uint32_t> bound_slots;          ///< slots that some vertex is bound to, ascending
  std::vector<SplitEdge> split_edges;         ///< of a network that can be cut
  /// [triangles] split edges 01, 12, 20, or kNoSplitEdge; empty unless a network's that can be cut
  std::vector<std::array<uint32_t, 3>> triangle_edges;
  bool can_be_cut = false;       ///< some tool of the scene may: wounds get ready (surface/wounds/wounds.h)
  bool two_sided = false;        ///< a sheet with borders: its back is not the inside of something
  size_t deep_vertices = 0;      ///< bound inside the body, too far from its boundary
  size_t constant_vertices = 0;  ///< that the mapping asked for cannot carry, so that the constant one does
  size_t bridges_removed = 0;    ///< triangles left out: they join pieces of tissue that nothing joins
};

/// Binds every vertex to the nearest triangle of the lattice's boundary (EGVE 3.3.1; the reference point is the closest
/// point, so weights are 0..1). A vertex deeper than one cell, as where parts of an organ meet, is bound to a face of
/// its own cell instead, so that it moves and is cut with the tissue around it.
/// In a lattice with cells that are tissue in part every vertex is, and while no spring of the cell's corners is cut it
/// goes where the eight corners carry it: its boundary faces lie outside of the tissue, on light and soft nodes.
/// Edges longer than the spacing are split first, so that a cut can open between any two lattice nodes.
/// Triangles that join nodes which no path of springs joins are left out.
/// That is Mapping::kAuto. The others (docs/mappings.md) bind to the boundary everywhere, and to a cell's face where a
/// vertex is deep.
/// @param solid  the one that `lattice` was built from
Skin bindSkin(const TriangleMesh& mesh, const Lattice& lattice, const Solid& solid, Mapping mapping = Mapping::kAuto,
              const Progress& progress = {});

}  // namespace viscera
