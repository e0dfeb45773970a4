// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <utility>
#include <vector>

#include "surface/wounds/wound_cells.h"
#include "surface/wounds/wound_mesh.h"
#include "surface/wounds/wound_skin.h"

namespace viscera {

/// The walls of the wounds of one body (docs/surface.md): surface nets of its cut springs, joined to the lips of the
/// surface mesh.
///
/// A cut cell has one point, the mean of where its springs and the surface mesh in it are cut, and a vertex there for
/// each side. A cut spring inside the tissue has two quads between the points of the four cells around it. A lip is
/// joined to its cell's point. Where lips continue in another cell, both cells' points are joined to the vertex
/// between. Small rings that remain open are filled. Then points are relaxed until none of their triangles is folded or
/// degenerate. Both sides coincide at rest, and every edge has one triangle on either side.
///
/// An update recomputes what is around changed cells and lips, and continues as far as that changes neighbours. Its
/// result does not depend on earlier updates. It keeps its memory for reuse.
class WoundWalls {
 public:
  /// Updates the walls, after the surface mesh has been updated for the same cells.
  void update(const CutCells& cells, const WoundSkin& skin);

  /// Returns triangles as indices [3 * n] into vertices().
  const std::vector<uint32_t>& triangles() const { return mesh_.corners(); }
  /// Returns the vertices. Their indices do not change; some are unused.
  const std::vector<WoundVertex>& vertices() const { return vertices_; }
  /// Returns the vertices that the last update has changed or may have bound to other nodes.
  const std::vector<uint32_t>& changed() const { return changed_; }
  /// Returns the vertex that belongs to one of WoundSkin::added(), or WoundMesh::kNone.
  uint32_t alongLip(uint32_t added) const { return added < lip_vertices_.size() ? lip_vertices_[added] : kNone; }
  /// Returns the number of wounds that stay open because they reach a border of the surface mesh.
  size_t holes() const { return hole_ends_.size(); }
  /// Returns how many points the last update has relaxed, counted once per try.
  size_t pointsTried() const { return points_tried_; }
  size_t trianglesMade() const { return mesh_.made(); }  ///< by all updates

 private:
  static constexpr uint32_t kNone = WoundMesh::kNone;
  static constexpr size_t kRounds = 3;  ///< of relaxation: points around one move too

  struct Point {
    std::array<Vector3d, kRounds + 1> at;  ///< before, and after each round
    uint32_t marks = 0;                    ///< number of cuts that the first is the mean of
    uint64_t order = 0;                    ///< the cell's
  };
  /// The triangles of a lip.
  struct Fan {
    uint32_t triangle = kNone;          ///< of the surface mesh; kNone: there is no lip
    uint32_t cell = kNone;              ///< the number of its cell, which lists it; kNone where it is in none
    uint32_t next = kNone;              ///< of that cell's fans
    uint32_t from = kNone, to = kNone;  ///< vertices of its ends
    std::array<uint32_t, 2> triangles{kNone, kNone};
  };
  struct Shape {
    double worst = 1, all = 1;  ///< of the triangles of a point
  };
  /// A triangle around a point, seen from the point.
  struct Facet {
    uint64_t order = 0;
    Vector3d b, c, outward;
    bool operator<(const Facet& other) const { return order < other.order; }
  };
  struct OpenEdge {
    uint64_t from_order = 0, to_order = 0;
    uint32_t from = 0, to = 0;
    bool operator<(const OpenEdge& other) const {
      return from_order < other.from_order || (from_order == other.from_order && to_order < other.to_order);
    }
  };
  /// Set of numbers seen in this update.
  struct Seen {
    std::vector<uint32_t> marks, list;
    void record(uint32_t i, uint32_t mark);
    bool has(uint32_t i, uint32_t mark) const { return i < marks.size() && marks[i] == mark; }
  };

  void clear();
  void makeRoom();
  // Points, quads and fans.
  void takeFans();
  void placeFan(uint32_t fan, const Lip& lip);
  void dropFan(uint32_t fan);
  void recordNeighborFans(uint32_t triangle);
  void placeLipVertex(uint32_t vertex);
  void findPoints();
  void findPoint(uint32_t cell);
  bool isInside(uint32_t slot, int axis) const;
  bool place(uint32_t vertex, const CutCell& cut, uint8_t component);
  void addQuads();
  void addQuad(uint32_t cell, int axis);
  bool isBetterAcross(const std::array<uint32_t, 4>& around) const;
  void addFans();
  void addFan(uint32_t fan);
  const Lip* lipBefore(const Lip& lip) const;
  void findOutward(uint32_t vertex);
  template <class Visit>
  void forEachLipAt(uint32_t skin_vertex, Visit visit) const;
  // Rings.
  void closeHoles();
  void gatherOpen(uint32_t vertex);
  void dropFill(uint32_t vertex);
  bool stepAlongHole();
  void closeRing(size_t first);
  void addFill(uint32_t a, uint32_t b, uint32_t c);
  void fillFromMiddle(const uint32_t* ring, size_t count);
  bool isEdge(uint32_t a, uint32_t b) const;
  // Relaxation of points.
  void relax();
  void askAround(uint32_t vertex);
  void ask(uint32_t cell, size_t round);
  void askOthersAround(uint32_t cell, size_t round);
  Vector3d relaxed(uint32_t cell, size_t round);
  void findFacets(uint32_t cell, size_t round);
  Shape shapeAt(const Vector3d& at) const;
  template <class Visit>
  void forEachTriangleOf(uint32_t cell, Visit visit) const;
  void setDown(uint32_t cell);
  Vector3d placeSeen(uint32_t vertex, uint32_t from_cell, size_t round) const;
  void findNormals();
  Vector3d firstPosition(uint32_t vertex) const;

  uint8_t sideOf(uint32_t cell, uint32_t node) const;
  uint32_t pointVertex(uint32_t cell, uint8_t component);
  uint32_t lipVertex(uint32_t skin_vertex);
  uint32_t newVertex(const WoundVertex& vertex, uint32_t cell);
  uint64_t orderOf(uint32_t vertex) const;
  void setTriangle(const std::array<uint32_t, 3>& corners, uint64_t order, uint32_t& known);
  void dropTriangle(uint32_t& known);
  void recordCorners(uint32_t triangle);
  void askAlways(uint32_t cell);

  const CutCells* cells_ = nullptr;
  const WoundSkin* skin_ = nullptr;
  uint32_t mark_ = 0;
  WoundMesh mesh_;
  std::vector<WoundVertex> vertices_;
  std::vector<uint32_t> cell_of_;                ///< [vertices] number of the cut cell of its point, or kNone
  std::vector<Vector3d> outward_;                ///< [vertices] direction across the wound; 0 where it has two sides
  std::vector<Point> points_;                    ///< [cells]
  std::vector<uint32_t> point_vertices_;         ///< [8 * cells] by component
  std::vector<std::array<uint32_t, 12>> quads_;  ///< [cells] triangles: 4 by axis
  std::vector<uint32_t> first_fans_;             ///< [cells]
  std::vector<Fan> fans_;                        ///< [6 * WoundSkin::shown()]
  std::vector<uint32_t> lip_vertices_;           ///< [WoundSkin::added()]
  std::vector<uint32_t> free_vertices_, changed_;
  std::vector<uint32_t> hole_ends_;                       ///< vertices where open paths end
  std::vector<std::pair<uint64_t, uint32_t>> cell_lips_;  ///< of one cell: order, fan
  Seen fans_to_make_, quads_to_make_, points_to_find_;    ///< of this update: fans, 3 * cells + axis, cells
  Seen cells_changed_;                                    ///< with springs or first places of points that have changed
  Seen touched_;                                ///< vertices with triangles, lips or first places that have changed
  Seen around_hole_;                            ///< and those along the holes that these belong to
  Seen to_shade_;                               ///< vertices
  Seen to_bind_;                                ///< likewise
  std::vector<std::pair<uint32_t, int>> ends_;  ///< of the edges of one vertex
  std::vector<OpenEdge> open_;                  ///< ascending
  std::vector<bool> walked_;                    ///< [open_]
  std::vector<uint32_t> path_;                  ///< along a hole
  uint64_t fills_ = 0;                          ///< in this update
  std::array<std::vector<std::pair<uint64_t, uint32_t>>, kRounds + 1> asked_;  ///< heaps of cells by their order
  std::array<std::vector<uint32_t>, kRounds + 1> asked_marks_;                 ///< [cells]
  std::vector<Facet> facets_;
  std::vector<std::pair<uint64_t, uint32_t>> ring_, around_;  ///< vertices, triangles: by their order
  size_t points_tried_ = 0;
};

/// Visits the lips that begin or end at a vertex of the surface mesh: visit(lip).
template <class Visit>
void WoundWalls::forEachLipAt(uint32_t skin_vertex, Visit visit) const {
  const auto of_triangle = [&](uint32_t triangle) {
    const uint32_t shown = triangle == kNone ? kNone : skin_->shownOf(triangle);
    if (shown == kNone) return;
    const VisiblePieces& pieces = skin_->shown()[shown];
    for (uint32_t i = 0; i < pieces.lip_count; ++i) {
      if (pieces.lips[i].from == skin_vertex || pieces.lips[i].to == skin_vertex) visit(pieces.lips[i]);
    }
  };
  const uint32_t edge = skin_->edgeOf(skin_vertex);
  if (edge == WoundSkin::kNoEdge) return of_triangle(skin_->triangleOf(skin_vertex));
  for (const uint32_t triangle : skin_->trianglesAt(edge)) of_triangle(triangle);
}

/// Visits the triangles at a cell's point: visit(name). Visits those between two of its vertices twice.
template <class Visit>
void WoundWalls::forEachTriangleOf(uint32_t cell, Visit visit) const {
  for (size_t component = 0; component < 8; ++component) {
    const uint32_t vertex = point_vertices_[8 * size_t{cell} + component];
    if (vertex != kNone) mesh_.forEachAt(vertex, [&](uint32_t triangle, uint32_t) { visit(triangle); });
  }
}

}  // namespace viscera
