// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include "layout/network_skin.h"
#include "layout/surface_node.h"
#include "viscera/model/model.h"

namespace viscera {

/// Returns whether the surface mesh of the body is its network: a vertex is a node (EGVE 3.2).
bool isOneToOne(const Body& body);

/// The surface meshes of all networks of a model in one, with the vertex and triangle numbers of Surface.
struct NetworkSkins {
  std::vector<layout::RingVertex> vertices;
  std::vector<layout::RingTriangle> rings;
  std::vector<layout::SplitEdge> edges;
  std::vector<layout::SplitTriangle> triangles;  ///< of bodies that can be cut

  /// Where the body begins in the buffers of Surface. Its split vertices follow its own.
  struct Offsets {
    uint32_t slot = 0, vertex = 0, triangle = 0, spring = 0;
  };
  void append(const Body& body, const Offsets& offsets);

 private:
  void appendRings(const Skin& skin, const Offsets& offsets);
  void appendSplits(const Skin& skin, const Offsets& offsets, uint32_t first_ring_vertex);
};

/// How approximate normals follow the tissue where vertices are turned by them (docs/surface.md): carried with the
/// tissue or, for comparison, summed again by VR05's eq 5. One_to_one and along_normal always sum.
enum class MovedNormals { kCarried, kSummed };

/// The surface meshes of all bodies in one, with global numbers of slots and vertices. Split vertices of a network
/// follow its own.
struct JoinedSkins {
  /// Nodes with approximate normals that some vertex uses: carried from rest, and summed in every state.
  std::vector<layout::SurfaceNode> carried_nodes, summed_nodes;
  std::vector<uint32_t> triangles, colors;
  std::vector<layout::SkinBinding> bindings;
  std::vector<layout::vec4> rests;  ///< [vertices] xyz at rest [m, tissue frame]; w 0: on the surface
  /// [triangles] texture charts of all bodies, numbered globally, or kNoChart; empty where no body has any
  std::vector<uint32_t> charts;
  NetworkSkins networks;
  bool any_bound = false, any_one_to_one = false;
  uint32_t kinds = 0;  ///< bits of SkinBinding.springs that occur in a lattice's surface mesh

  void append(const Body& body, const NetworkSkins::Offsets& offsets, MovedNormals normals);

 private:
  void appendBindings(const Skin& skin, uint32_t slot_offset);
  void appendNormalNodes(const Body& body, uint32_t slot_offset, MovedNormals normals);
  void appendTriangles(const Skin& skin, const NetworkSkins::Offsets& offsets);
  void appendRests(const Skin& skin);
  void appendCharts(const Skin& skin, const NetworkSkins::Offsets& offsets);
  uint32_t charts_before_ = 0, bodies_ = 0;  ///< of the bodies so far
};
JoinedSkins joinSkins(const Model& model, MovedNormals normals = MovedNormals::kCarried);

/// Returns the split vertices of every triangle for appendShown: [6 * triangles]; empty where no triangle can split.
std::vector<uint32_t> splitsOf(const JoinedSkins& skins);

/// Returns the bricks that showing a state reads, ascending: those of the nodes to which surface meshes are bound and
/// of their neighbours, and all bricks of bodies that can be cut.
std::vector<uint32_t> shownBricks(const Model& model);

}  // namespace viscera
