// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include "layout/network_skin.h"
#include "layout/surface_node.h"
#include "viscera/model/model.h"

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

/// How approximate normals follow where vertices are turned by them (docs/mappings.md): turned as the tissue is, or, to
/// compare, summed again as VR05's eq 5 is. One_to_one and along_normal sum in any case.
enum class MovedNormals { kCarried, kSummed };

/// The skins of all bodies as one: slots and vertices numbered through. Split vertices of a network follow its own.
struct JoinedSkins {
  /// Whose approximate normals some vertex follows: carried from rest, and summed in every state.
  std::vector<layout::SurfaceNode> carried_nodes, summed_nodes;
  std::vector<uint32_t> triangles, colors;
  std::vector<layout::SkinBinding> bindings;
  std::vector<layout::vec4> rests;  ///< [vertices] xyz at rest [m, tissue frame]; w 0: on the skin
  /// [triangles] texture charts of all bodies, numbered through, or kNoChart; empty where no body has any
  std::vector<uint32_t> charts;
  NetworkSkins networks;
  bool any_bound = false, any_one_to_one = false;
  uint32_t kinds = 0;  ///< bits of SkinBinding.springs that some vertex of a lattice's skin has

  void append(const Body& body, const NetworkSkins::Place& place, MovedNormals normals);

 private:
  void appendBindings(const Skin& skin, uint32_t slot_offset);
  void appendNormalNodes(const Body& body, uint32_t slot_offset, MovedNormals normals);
  void appendTriangles(const Skin& skin, const NetworkSkins::Place& place);
  void appendRests(const Skin& skin);
  void appendCharts(const Skin& skin, const NetworkSkins::Place& place);
  uint32_t charts_before_ = 0, bodies_ = 0;  ///< of the bodies so far
};
JoinedSkins joinSkins(const Model& model, MovedNormals normals = MovedNormals::kCarried);

/// Split vertices of every triangle, as appendShown takes them: [6 * triangles]; empty where no triangle can split.
std::vector<uint32_t> splitsOf(const JoinedSkins& skins);

/// Bricks of the nodes to which skins are bound and of their neighbours, ascending, and all of bodies that can be cut:
/// all that showing a state looks at.
std::vector<uint32_t> shownBricks(const Model& model);

}  // namespace viscera
