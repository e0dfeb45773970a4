// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <utility>
#include <vector>

#include "surface/wound_cells.h"
#include "surface/wound_skin_index.h"
#include "viscera/model/body/skin.h"

namespace viscera {

/// A stretch of the border of a skin piece along a wound: the wall that begins there has its other end on the same
/// nodes.
struct Lip {
  uint32_t from = 0, to = 0;  ///< vertices, in the order in which the piece has them
  uint32_t triangle = 0;      ///< of the uncut skin
  uint32_t cell = kNoCell;    ///< slot of the lowest corner of the cut cell that holds it; kNoCell where none does
  uint32_t node = 0;          ///< a corner of that cell, on the side of the piece
  Vector3d outward = Vector3d::Zero();  ///< unit, from the piece across the wound

  static constexpr uint32_t kNoCell = UINT32_MAX;
};

/// A vertex of a wounded skin beyond the skin's own.
struct WoundVertex {
  Vector3d point = Vector3d::Zero();  ///< at rest, in cells from the lattice's origin
  Vector3d normal = Vector3d::Zero();
  WoundPlace place;
  uint32_t skin_vertex =
      kNone;  ///< of a wall's border: the vertex of the skin that it goes with; of a lip: one that it looks like

  static constexpr uint32_t kNone = UINT32_MAX;
};

/// The skin of one body, split where its edges cross from one side of a wound to the other (docs/wounds.md 2). An edge
/// that does has two vertices at the crossing, one of either side. A triangle with two such edges is parted into a
/// corner and the rest, one with three into three corners that meet in its middle. In one with a single crossed edge
/// the wound ends, at a vertex of both sides in the direction in which it comes. Work follows the wound's size, and all
/// memory is kept.
class WoundSkin {
 public:
  /// @param skin, lattice  of one body; the skin must outlive this
  WoundSkin(const Skin& skin, const Lattice& lattice);

  void update(const CutCells& cells);

  /// [3 * n] vertices: below own() they are the skin's, the others follow in added(). Whole triangles are where they
  /// are in the skin, so is one piece of each split one, others follow; where there are fewer than before, the last
  /// ones fill the gaps.
  const std::vector<uint32_t>& triangles() const { return triangles_; }
  /// [n] which triangle of the uncut skin each of triangles() is a piece of.
  const std::vector<uint32_t>& sources() const { return sources_; }
  const std::vector<Lip>& lips() const { return lips_; }
  const std::vector<WoundVertex>& added() const { return added_; }
  /// The skin's own vertices that have to be bound anew: their triangle of nodes lies on two sides, or on the other
  /// one.
  const std::vector<std::pair<uint32_t, WoundVertex>>& rebound() const { return rebound_; }
  /// Which edge's copy a vertex is, or kNoEdge: copies of an edge belong to its two triangles.
  uint32_t edgeOf(uint32_t vertex) const { return vertex < own_ ? kNoEdge : edge_of_[vertex - own_]; }
  /// Is it where a wound ends, a vertex of both of its sides?
  bool isEnd(uint32_t vertex) const { return vertex >= own_ && is_end_[vertex - own_]; }
  Vector3d pointOf(uint32_t vertex) const {
    return vertex < own_ ? index_.points[vertex] : added_[vertex - own_].point;
  }
  const WoundPlace& placeOf(uint32_t vertex) const {
    return vertex < own_ ? places_[vertex] : added_[vertex - own_].place;
  }
  uint32_t own() const { return own_; }
  size_t slivers() const { return slivers_; }  ///< edges of which a piece between two wounds is not shown

  static constexpr uint32_t kNoEdge = UINT32_MAX;

 private:
  struct Step {
    double before = 0, behind = 0;  ///< share of the edge
    WoundPlace from, to;
  };
  void forget();
  void findNear(const CutCells& cells);
  void findGone(const CutCells& cells);
  void findPlaces(const CutCells& cells);
  void splitEdge(const CutCells& cells, uint32_t edge);
  void findSteps(const CutCells& cells, uint32_t edge, double first, const WoundPlace& from, double last,
                 const WoundPlace& to);
  uint32_t crossedEdges(uint32_t triangle) const;
  uint32_t onlyCrossed(uint32_t triangle) const;
  void dropLonely();
  Vector3d endOf(uint32_t triangle, uint32_t first) const;
  uint32_t addVertex(const WoundVertex& vertex, uint32_t edge, bool is_end);
  void show(const CutCells& cells, uint32_t triangle);
  void showTapered(const CutCells& cells, uint32_t triangle, uint32_t first);
  void showParted(const CutCells& cells, uint32_t triangle, uint32_t corner);
  void showStar(const CutCells& cells, uint32_t triangle);
  uint32_t copyAt(uint32_t edge, uint32_t vertex) const;
  void addPiece(const CutCells& cells, uint32_t triangle, std::initializer_list<uint32_t> vertices);
  void addTriangle(uint32_t source, uint32_t a, uint32_t b, uint32_t c);
  void closeGaps();
  void setTriangle(size_t at, uint32_t source, const uint32_t* corners);
  void addLip(const CutCells& cells, uint32_t triangle, uint32_t from, uint32_t to, uint32_t corner);
  bool isShown(const CutCells& cells, uint32_t vertex) const { return !cells.isGone(placeOf(vertex).node); }

  /// What was seen in this update: no two updates have the same mark.
  struct Seen {
    std::vector<uint32_t> marks;
    bool first(uint32_t i, uint32_t mark) { return marks[i] != mark && (marks[i] = mark, true); }
  };

  const Skin& skin_;
  const WoundSkinIndex index_;
  uint32_t own_ = 0, mark_ = 0;
  std::vector<WoundPlace> places_;  ///< [own] of vertices
  std::vector<uint32_t> near_;      ///< triangles in cut cells, ascending
  std::vector<uint32_t> gone_;      ///< other ones, around nodes that have lost all of their springs
  Seen seen_triangles_, seen_vertices_, seen_edges_;
  std::vector<uint32_t> crossed_;   ///< edges with copies
  std::vector<uint32_t> copies_;    ///< [edges] the first of its two added vertices, or kNoEdge
  std::vector<Step> steps_;         ///< of one edge
  std::vector<uint32_t> replaced_;  ///< triangles that are not whole
  std::vector<uint32_t> gaps_;      ///< of them those of which nothing is shown
  bool place_is_free_ = false;      ///< of the triangle that is being shown
  std::vector<uint32_t> edge_of_;   ///< [added_]
  std::vector<bool> is_end_;        ///< [added_]
  std::vector<uint32_t> triangles_, sources_;
  std::vector<Lip> lips_;
  std::vector<WoundVertex> added_;
  std::vector<std::pair<uint32_t, WoundVertex>> rebound_;
  size_t slivers_ = 0;
};

}  // namespace viscera
