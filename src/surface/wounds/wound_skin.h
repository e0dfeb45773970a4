// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <utility>
#include <vector>

#include "surface/wounds/wound_cells.h"
#include "surface/wounds/wound_skin_index.h"
#include "viscera/model/body/skin.h"

namespace viscera {

/// A piece of the border of the surface mesh along a wound. The wall begins there, bound to the same nodes.
struct Lip {
  uint32_t from = 0, to = 0;            ///< vertices, in the order in which the piece has them
  uint32_t triangle = 0;                ///< of the uncut mesh
  uint32_t cell = kNoCell;              ///< slot of the lowest corner of its cut cell; kNoCell where there is none
  uint32_t node = 0;                    ///< a corner of that cell, on the side of the piece
  Vector3d outward = Vector3d::Zero();  ///< unit, from the piece across the wound

  static constexpr uint32_t kNoCell = UINT32_MAX;
};

/// A vertex of a wounded surface mesh in addition to the mesh's own.
struct WoundVertex {
  Vector3d point = Vector3d::Zero();  ///< at rest, in cells from the lattice's origin
  Vector3d normal = Vector3d::Zero();
  WoundPoint position;
  uint32_t skin_vertex = kNone;  ///< of a wall: its vertex on the surface mesh; of a lip: one with the same look

  static constexpr uint32_t kNone = UINT32_MAX;
};

/// Shown pieces of a triangle of the surface mesh that is not whole.
struct VisiblePieces {
  uint32_t triangle = UINT32_MAX;  ///< kNone: of no triangle now
  uint8_t count = 0, lip_count = 0, inside_count = 0;
  std::array<std::array<uint32_t, 3>, 6> pieces{};  ///< [count]
  std::array<Lip, 6> lips;                          ///< [lip_count]
  std::array<uint32_t, 3> inside{};  ///< [inside_count] its vertices within the triangle: ends of wounds, or middles
};

/// The surface mesh of one body, split where its edges cross a wound (docs/surface.md). A crossed edge gets two
/// vertices at the crossing, one per side. A triangle with two such edges is split into a corner and the rest, one with
/// three into three corners that meet in its middle. In a triangle with a single crossed edge the wound ends, at a
/// vertex that both sides share. An update visits triangles around changed cells, and copies the rest. Its result does
/// not depend on earlier updates. It keeps its memory for reuse.
class WoundSkin {
 public:
  static constexpr uint32_t kNoEdge = UINT32_MAX, kNone = UINT32_MAX;

  /// @param skin, lattice  of one body; the skin must outlive this
  WoundSkin(const Skin& skin, const Lattice& lattice);

  void update(const CutCells& cells);

  /// Returns triangles [3 * n]: vertices below own() are the mesh's, the others follow in added(). Whole triangles keep
  /// their place, as does one piece of each split one; other pieces follow. Where there are fewer than before, the last
  /// ones fill the gaps.
  const std::vector<uint32_t>& triangles() const { return triangles_; }
  /// Returns the triangle of the uncut mesh [n] that each of triangles() is a piece of.
  const std::vector<uint32_t>& sources() const { return sources_; }
  /// Returns the triangles that are not whole. Their indices do not change.
  const std::vector<VisiblePieces>& shown() const { return shown_; }
  /// Returns those of them with lips, or places of lips, that the last update has changed; some are of no triangle any
  /// more.
  const std::vector<uint32_t>& changed() const { return changed_; }
  /// Returns the index of a triangle in shown(), or kNone.
  uint32_t shownOf(uint32_t triangle) const { return shown_of_[triangle]; }
  const std::array<uint32_t, 2>& trianglesAt(uint32_t edge) const { return index_.edge_triangles[edge]; }
  const std::array<uint32_t, 3>& edgesOf(uint32_t triangle) const { return index_.triangle_edges[triangle]; }
  /// Returns the added vertices. Their indices do not change; some are unused.
  const std::vector<WoundVertex>& added() const { return added_; }
  /// Returns the mesh's own vertices that must be bound again: their triangle of nodes is cut, or on the other side.
  const std::vector<uint32_t>& rebound() const { return rebound_; }
  bool isRebound(uint32_t own) const { return rebound_at_[own] != kNone; }
  /// Returns own vertices, and added ones by their index in added(), that the last update has visited. Bindings of all
  /// others are unchanged.
  const std::vector<uint32_t>& lookedAt() const { return looked_at_; }
  const std::vector<uint32_t>& lookedAtAdded() const { return looked_at_added_; }
  WoundVertex own(uint32_t vertex) const {
    return {index_.points[vertex], index_.normals[vertex].cast<double>(), positions_[vertex], vertex};
  }
  /// Returns the edge that a vertex belongs to, or kNoEdge. Vertices of an edge belong to its two triangles.
  uint32_t edgeOf(uint32_t vertex) const { return vertex < own_ ? kNoEdge : owners_[vertex - own_].edge; }
  /// Returns the triangle that contains an added vertex that belongs to no edge.
  uint32_t triangleOf(uint32_t vertex) const { return owners_[vertex - own_].triangle; }
  /// Returns the order of an added vertex, which does not depend on the order of cuts.
  uint64_t orderOf(uint32_t vertex) const;
  /// Returns whether the vertex is the end of a wound, which both sides share, or is unused.
  bool isEnd(uint32_t vertex) const { return vertex >= own_ && is_end_[vertex - own_]; }
  const Vector3d& pointOf(uint32_t vertex) const {
    return vertex < own_ ? index_.points[vertex] : added_[vertex - own_].point;
  }
  const WoundPoint& positionOf(uint32_t vertex) const {
    return vertex < own_ ? positions_[vertex] : added_[vertex - own_].position;
  }
  uint32_t ownCount() const { return own_; }
  size_t visitedCount() const { return near_.size(); }  ///< triangles that the last update has visited
  size_t slivers() const { return slivers_; }           ///< edges with a piece between two wounds that is not shown

 private:
  struct Step {
    double before = 0, behind = 0;  ///< shares of the edge
    WoundPoint from, to;
  };
  /// Owner of an added vertex.
  struct Owner {
    uint32_t edge = kNoEdge, triangle = kNone;
    uint32_t which = 0;  ///< end of the edge, or place in VisiblePieces::inside
  };
  void clear();
  void findNear(const CutCells& cells);
  void findPositions(const CutCells& cells);
  void updateVertex(const CutCells& cells, uint32_t vertex);
  bool isNear(const CutCells& cells, uint32_t triangle) const;
  bool isNearGone(const CutCells& cells, uint32_t triangle) const;
  void updateEdges(const CutCells& cells);
  void updateEdge(const CutCells& cells, uint32_t edge);
  bool findCrossing(const CutCells& cells, uint32_t edge, bool& sliver);
  void findSteps(const CutCells& cells, uint32_t edge, double first, const WoundPoint& from, double last,
                 const WoundPoint& to);
  uint32_t onlyFound(uint32_t triangle) const;
  bool isLonely(uint32_t edge) const;
  void dropLonely();
  uint32_t crossedEdges(uint32_t triangle) const;
  Vector3d endOf(uint32_t triangle, uint32_t first) const;
  uint32_t newVertices(size_t count, std::vector<uint32_t>& freed);
  void setVertex(uint32_t vertex, const WoundVertex& to, const Owner& owner, bool is_end);
  void free(uint32_t vertex);
  void recordVisited(uint32_t vertex);
  uint32_t addInside(VisiblePieces& out, const WoundVertex& vertex, bool is_end);
  void show(const CutCells& cells, uint32_t triangle);
  void cutUp(const CutCells& cells, uint32_t crossed, VisiblePieces& out);
  void showTapered(const CutCells& cells, uint32_t first, VisiblePieces& out);
  void showParted(const CutCells& cells, uint32_t corner, VisiblePieces& out);
  void showStar(const CutCells& cells, VisiblePieces& out);
  bool isOtherThan(const VisiblePieces& before, const VisiblePieces& now) const;
  uint32_t copyAt(uint32_t edge, uint32_t vertex) const;
  void addPiece(const CutCells& cells, std::initializer_list<uint32_t> vertices, VisiblePieces& out) const;
  void addLip(const CutCells& cells, uint32_t from, uint32_t to, uint32_t corner, VisiblePieces& out) const;
  void writeTriangles();
  void closeGaps();
  void setTriangle(size_t at, uint32_t source, const uint32_t* corners);
  bool isShown(const CutCells& cells, uint32_t vertex) const { return !cells.isGone(positionOf(vertex).node); }

  /// Set of numbers seen in this update: no two updates have the same mark.
  struct Seen {
    std::vector<uint32_t> marks;
    bool first(uint32_t i, uint32_t mark) { return marks[i] != mark && (marks[i] = mark, true); }
  };

  const Skin& skin_;
  const WoundSkinIndex index_;
  uint32_t own_ = 0, mark_ = 0;
  int reach_ = 0;                      ///< cells from a change to what it may affect
  std::vector<WoundPoint> positions_;  ///< [own] of vertices
  std::vector<uint32_t> near_;         ///< triangles to visit
  Seen seen_triangles_, seen_vertices_, seen_edges_, judged_edges_;
  std::vector<uint32_t> found_;          ///< [edges] the first of the two vertices of a crossing, or kNoEdge
  std::vector<uint32_t> copies_;         ///< [edges] the same, of wounds with more than one crossing
  std::vector<bool> is_sliver_;          ///< [edges]
  std::vector<uint32_t> changed_edges_;  ///< in this update
  std::vector<Step> steps_;              ///< of one edge
  std::array<WoundVertex, 2> crossing_;  ///< of one edge
  std::vector<uint32_t> shown_of_;       ///< [triangles]
  std::vector<VisiblePieces> shown_;
  std::vector<uint32_t> free_shown_, changed_;
  std::vector<WoundVertex> added_;
  std::vector<Owner> owners_;                           ///< [added_]
  std::vector<bool> is_end_;                            ///< [added_]
  std::vector<uint32_t> changed_marks_, looked_marks_;  ///< [added_] the last update that has changed, or visited, it
  std::vector<uint32_t> free_vertices_, free_pairs_;    ///< free vertices; first ones of free pairs
  std::vector<uint32_t> triangles_, sources_;
  std::vector<uint32_t> moved_;  ///< whole triangles with places that are cut off or taken
  std::vector<uint32_t> gaps_;   ///< places of triangles of which nothing is shown
  std::vector<uint32_t> rebound_, rebound_at_, looked_at_, looked_at_added_;
  size_t slivers_ = 0;
};

}  // namespace viscera
