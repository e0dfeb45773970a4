// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace viscera {

/// Edges of a tetrahedron by its corners; the one opposite to e is 5 - e.
constexpr std::array<std::array<uint8_t, 2>, 6> kTetrahedronEdges = {{{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}}};
/// Faces of a tetrahedron of positive volume, counter-clockwise seen from outside.
constexpr std::array<std::array<uint8_t, 3>, 4> kTetrahedronFaces = {{{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}}};

/// The edge between two corners of a tetrahedron.
size_t tetrahedronEdge(size_t a, size_t b);

/// A vertex of the pieces that cuts make of a triangle. Edge i joins the corners i and i + 1.
struct FaceVertex {
  enum Kind : uint8_t {
    kCorner,  ///< its own
    kLip,     ///< on a cut edge, of one of the edge's ends
    kMiddle,  ///< where three cuts meet, of one corner
    kEnd,     ///< where a wound ends that crosses one edge: of both of its sides
  };
  Kind kind = kCorner;
  uint8_t corner = 0;  ///< on which it hangs
  uint8_t edge = 0;    ///< of a lip, or that an ended wound crosses
};

/// What cuts of its edges make of a triangle (docs/wounds.md 4). With two cut, the corner between them is parted from
/// the rest; with three, all corners, by lines that meet in the middle; with one, the wound ends inside.
struct FacePieces {
  /// Of a piece, counter-clockwise as the triangle is; `corner` is one of the piece's.
  struct Triangle {
    std::array<FaceVertex, 3> vertices;
    uint8_t corner;
  };
  /// A stretch of a piece's border along the wound, in the direction in which the piece has it.
  struct Border {
    FaceVertex from, to;
    uint8_t corner;
  };
  std::vector<Triangle> triangles;
  std::vector<Border> borders;
};
/// @param cut  bits of the edges 0, 1, 2
const FacePieces& facePieces(uint32_t cut);

/// A vertex of a wall inside a tetrahedron.
struct WallVertex {
  enum Kind : uint8_t { kLip, kMiddle, kEnd, kCentre };
  Kind kind = kLip;
  uint8_t at = 0;      ///< edge of a lip, face of a middle or an end, component of a centre
  uint8_t corner = 0;  ///< of the tetrahedron, on which it hangs; of an end: any of its face's
};

/// The walls that a cut leaves in a tetrahedron, for each set of cut edges. They are bordered by the lines of its
/// faces, which follow from a face's own edges, so that neighbours meet; both sides of them are there. A clean cut, of
/// one corner or of two from two, is a triangle or two; any other one a cone from a point in the middle, of which each
/// component of the corners (under whole edges) has a vertex.
struct TetrahedronWalls {
  struct Triangle {
    std::array<WallVertex, 3> vertices;
    uint8_t corner;  ///< of the side that the triangle closes
  };
  std::array<uint8_t, 4> component{};  ///< [corners] the lowest corner of its component
  std::vector<Triangle> triangles;
  /// Of a cut of two corners from two: the same with the other diagonal. `triangles` has the one between the lips on
  /// the edges diagonal and 5 - diagonal, these the one between other_diagonal and 5 - other_diagonal.
  std::vector<Triangle> others;
  uint8_t diagonal = 0, other_diagonal = 0;
  bool has_centre = false;
};
/// @param cut  bits of kTetrahedronEdges
const TetrahedronWalls& tetrahedronWalls(uint32_t cut);

}  // namespace viscera
