// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What cuts of its edges make of a tetrahedron, for all 64 sets of them.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>
#include <tuple>

#include "surface/tetrahedra_rig.h"
#include "surface/wound_checks.h"
#include "surface/wounds/tetrahedron_walls.h"

namespace viscera::testing {
namespace {

/// Names of vertices by numbers: of corners and of walls alike.
class Names {
 public:
  uint32_t of(int kind, int at, int corner) {
    return numbers_.emplace(std::make_tuple(kind, at, corner), numbers_.size()).first->second;
  }

 private:
  std::map<std::tuple<int, int, int>, uint32_t> numbers_;
};

uint32_t faceCuts(uint32_t cut, size_t face) {
  uint32_t bits = 0;
  const auto& c = kTetrahedronFaces[face];
  for (size_t i = 0; i < 3; ++i) bits |= (cut >> tetrahedronEdge(c[i], c[(i + 1) % 3]) & 1U) << i;
  return bits;
}

uint32_t nameOf(Names& names, size_t face, const FaceVertex& v) {
  const auto& c = kTetrahedronFaces[face];
  switch (v.kind) {
    case FaceVertex::kCorner:
      return names.of(0, c[v.corner], 0);
    case FaceVertex::kLip:
      return names.of(1, static_cast<int>(tetrahedronEdge(c[v.edge], c[(v.edge + 1U) % 3])), c[v.corner]);
    case FaceVertex::kMiddle:
      return names.of(2, static_cast<int>(face), c[v.corner]);
    default:
      return names.of(3, static_cast<int>(face), 0);
  }
}

uint32_t nameOf(Names& names, const WallVertex& v) {
  switch (v.kind) {
    case WallVertex::kLip:
      return names.of(1, v.at, v.corner);
    case WallVertex::kMiddle:
      return names.of(2, v.at, v.corner);
    case WallVertex::kEnd:
      return names.of(3, v.at, 0);
    default:
      return names.of(4, v.at, 0);
  }
}

/// The four faces and the walls of a cut tetrahedron, by names.
std::vector<uint32_t> piecesOf(uint32_t cut, bool others) {
  Names names;
  std::vector<uint32_t> out;
  for (size_t face = 0; face < 4; ++face) {
    for (const FacePieces::Triangle& t : facePieces(faceCuts(cut, face)).triangles)
      for (const FaceVertex& v : t.vertices) out.push_back(nameOf(names, face, v));
  }
  const TetrahedronWalls& walls = tetrahedronWalls(cut);
  for (const TetrahedronWalls::Triangle& t : others ? walls.others : walls.triangles)
    for (const WallVertex& v : t.vertices) out.push_back(nameOf(names, v));
  return out;
}

size_t bodiesOf(const std::vector<uint32_t>& triangles) {
  std::vector<uint32_t> parent(triangles.empty() ? 0 : *std::max_element(triangles.begin(), triangles.end()) + 1U);
  for (uint32_t v = 0; v < parent.size(); ++v) parent[v] = v;
  const auto root = [&](uint32_t v) {
    while (parent[v] != v) v = parent[v];
    return v;
  };
  for (size_t t = 0; t < triangles.size(); t += 3) {
    parent[root(triangles[t])] = root(triangles[t + 1]);
    parent[root(triangles[t + 1])] = root(triangles[t + 2]);
  }
  std::set<uint32_t> roots;
  for (const uint32_t v : triangles) roots.insert(root(v));
  return roots.size();
}

TEST(TetrahedronWalls, EveryCutLeavesClosedPieces) {
  for (uint32_t cut = 0; cut < 64; ++cut) {
    SCOPED_TRACE(::testing::Message() << "edges " << cut);
    const TetrahedronWalls& walls = tetrahedronWalls(cut);
    const std::set<uint8_t> components(walls.component.begin(), walls.component.end());
    for (const bool others : {false, true}) {
      if (others && walls.others.empty()) continue;
      const std::vector<uint32_t> pieces = piecesOf(cut, others);
      EXPECT_EQ(edgeCounts(pieces).open, 0u);
      EXPECT_EQ(edgeCounts(pieces).shared, 0u);
      EXPECT_EQ(bodiesOf(pieces), components.size());
    }
  }
}

TEST(TetrahedronWalls, CleanCutsAreFlat) {
  size_t corners = 0, quads = 0;
  for (uint32_t cut = 1; cut < 64; ++cut) {
    const TetrahedronWalls& walls = tetrahedronWalls(cut);
    if (walls.has_centre) continue;
    (walls.others.empty() ? corners : quads) += 1;
    EXPECT_EQ(walls.triangles.size(), walls.others.empty() ? 2u : 4u) << cut;
  }
  EXPECT_EQ(corners, 4u);
  EXPECT_EQ(quads, 3u);
}

TEST(TetrahedronWalls, ATriangleOfAWallNamesItsOwnSide) {
  for (uint32_t cut = 0; cut < 64; ++cut) {
    const TetrahedronWalls& walls = tetrahedronWalls(cut);
    for (const TetrahedronWalls::Triangle& t : walls.triangles) {
      for (const WallVertex& v : t.vertices) {
        if (v.kind == WallVertex::kEnd) continue;  // of both sides
        EXPECT_EQ(walls.component[v.corner], walls.component[t.corner]) << cut;
      }
    }
  }
}

}  // namespace
}  // namespace viscera::testing
