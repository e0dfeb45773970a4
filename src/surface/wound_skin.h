// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <utility>
#include <vector>

#include "surface/wound_cells.h"
#include "viscera/model/body/skin.h"

namespace viscera {

/// A stretch of the border of a skin piece along a wound: the wall that begins there has its other end on the same
/// nodes.
struct Lip {
  uint32_t from = 0, to = 0;  ///< vertices, in the order in which the piece has them
  uint32_t triangle = 0;      ///< of the uncut skin
  uint32_t cell = kNoCell;    ///< slot of the lowest corner of the cut cell that holds it; kNoCell where none does
  uint32_t node = 0;          ///< a corner of that cell, on the side of the piece

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
/// that does has two vertices at the crossing, one of either side. A triangle with one such edge tapers the wound to
/// its third corner, with two is parted into a corner and the rest, with three into three corners that meet in its
/// middle.
class WoundSkin {
 public:
  /// @param skin, lattice  of one body; the skin must outlive this
  WoundSkin(const Skin& skin, const Lattice& lattice);

  void update(const CutCells& cells);

  /// [3 * n] vertices: below bindings().size() of the skin they are its own, the others follow in added().
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
  Vector3d pointOf(uint32_t vertex) const { return vertex < own_ ? points_[vertex] : added_[vertex - own_].point; }
  Vector3d normalOf(uint32_t vertex) const {
    return vertex < own_ ? normals_[vertex].cast<double>() : added_[vertex - own_].normal;
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
  void findPlaces(const CutCells& cells);
  void splitEdge(const CutCells& cells, uint32_t edge);
  void findSteps(const CutCells& cells, uint32_t edge, double first, const WoundPlace& from, double last,
                 const WoundPlace& to, std::vector<Step>& out) const;
  void show(const CutCells& cells, uint32_t triangle);
  void showTapered(const CutCells& cells, uint32_t triangle, uint32_t first);
  void showParted(const CutCells& cells, uint32_t triangle, uint32_t corner);
  void showStar(const CutCells& cells, uint32_t triangle);
  uint32_t copyAt(uint32_t edge, uint32_t vertex) const;
  void addPiece(const CutCells& cells, uint32_t triangle, std::initializer_list<uint32_t> vertices);
  void addLip(const CutCells& cells, uint32_t triangle, uint32_t from, uint32_t to, uint32_t corner);
  bool isShown(const CutCells& cells, uint32_t vertex) const { return !cells.isGone(placeOf(vertex).node); }

  const Skin& skin_;
  uint32_t own_ = 0;
  std::vector<Vector3d> points_;
  std::vector<Vector3f> normals_;
  std::vector<std::array<uint32_t, 2>> edges_;           ///< lower vertex first
  std::vector<std::array<uint32_t, 3>> triangle_edges_;  ///< 01, 12, 20
  std::vector<uint32_t> touched_starts_, touched_;       ///< cells that a triangle lies in
  std::vector<WoundPlace> places_;                       ///< [own] of vertices
  std::vector<uint32_t> copies_;                         ///< [edges] the first of its two added vertices, or kNoEdge
  std::vector<uint32_t> edge_of_;
  std::vector<uint32_t> triangles_, sources_;
  std::vector<Lip> lips_;
  std::vector<WoundVertex> added_;
  std::vector<std::pair<uint32_t, WoundVertex>> rebound_;
  size_t slivers_ = 0;
};

}  // namespace viscera
