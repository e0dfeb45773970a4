// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <utility>
#include <vector>

#include "surface/wound_cells.h"
#include "surface/wound_skin.h"

namespace viscera {

/// The walls of the wounds of one body (docs/wounds.md 3): surface nets of its cut springs, sewn to the lips of the
/// skin. A cut cell has one point, the mean of where its springs and the skin in it are cut, and a vertex there for
/// each side; a cut spring inside the tissue has two quads between the points of the four cells around it; a lip is
/// joined to its cell's point, and where lips go on in another cell, both cells' points to the vertex between; small
/// rings that this leaves are filled. Points then give way until no triangle of theirs is folded or as good as a line.
/// Both sides are in one place at rest, and every edge has one triangle on either hand. All memory is kept.
class WoundWalls {
 public:
  void update(const CutCells& cells, const WoundSkin& skin);

  /// [3 * n] indices into vertices().
  const std::vector<uint32_t>& triangles() const { return triangles_; }
  const std::vector<WoundVertex>& vertices() const { return vertices_; }
  /// Wounds that cannot be closed since they run out of the skin at a border of it.
  size_t holes() const { return holes_; }

 private:
  static constexpr uint32_t kNone = UINT32_MAX;
  struct Point {
    Vector3d at = Vector3d::Zero();
    uint32_t marks = 0;  ///< how many `at` is the mean of
  };
  /// Where a lip ends: the vertex, and the triangle of the skin where it lies within one.
  struct LipEnd {
    uint64_t key = 0;
    uint32_t lip = 0;
    bool operator<(const LipEnd& other) const { return key < other.key; }
  };
  struct Shape {
    double worst = 1, all = 1;  ///< of the triangles of a point
  };
  struct OpenEdge {
    uint32_t from = 0, to = 0;
    bool operator<(const OpenEdge& other) const { return from < other.from || (from == other.from && to < other.to); }
  };

  void begin();
  void findPoints();
  void addQuads();
  void addQuad(const std::array<uint32_t, 4>& around, bool other_diagonal);
  bool isBetterAcross(const std::array<uint32_t, 4>& around) const;
  void addFans();
  void findOpenEdges();
  void closeHoles();
  bool stepAlongHole();
  void closeRing(size_t first);
  bool isEdge(uint32_t a, uint32_t b) const;
  void relax();
  void relaxPoint(uint32_t cell);
  Shape shapeAt(uint32_t cell, const Vector3d& at) const;
  void listTrianglesOfCells();
  bool isInside(uint32_t slot, int axis) const;
  uint8_t sideOf(uint32_t cell, uint32_t node) const;
  uint32_t pointVertex(uint32_t cell, uint8_t component);
  uint32_t lipVertex(uint32_t skin_vertex);
  uint32_t addVertex(const WoundVertex& vertex, uint32_t cell, const Vector3d& outward);
  void add(uint32_t a, uint32_t b, uint32_t c);
  void findNormals();

  const CutCells* cells_ = nullptr;
  const WoundSkin* skin_ = nullptr;
  std::vector<uint32_t> triangles_;
  std::vector<WoundVertex> vertices_;
  std::vector<uint32_t> cell_of_;         ///< [vertices] index of the cut cell whose point it is, or kNone
  std::vector<Vector3d> outward_;         ///< [vertices] from its side across the wound; 0 where it has two
  std::vector<Point> points_;             ///< [cut cells]
  std::vector<uint32_t> point_vertices_;  ///< [8 * cut cells] by component
  std::vector<uint32_t> lip_vertices_;    ///< [vertices of the skin]
  std::vector<LipEnd> lip_ends_;
  std::vector<std::pair<uint64_t, int>> edges_;  ///< both ends, lower first: triangles that way, less the other way
  std::vector<uint64_t> chords_;                 ///< edges that filled rings have added
  std::vector<OpenEdge> open_;                   ///< ascending
  std::vector<bool> walked_;                     ///< [open_]
  std::vector<uint32_t> way_;                    ///< along a hole
  std::vector<uint32_t> cell_starts_, cell_triangles_, ring_;
  size_t holes_ = 0, first_open_ = 0;
};

}  // namespace viscera
