// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>

#include "math/union_find.h"
#include "model/shape/solid/joined_parts.h"
#include "model/shape/solid/solid_crumbs.h"

namespace viscera {
namespace {

/// Returns the connected piece of each vertex of a shell, named by its first vertex.
std::vector<uint32_t> piecesOf(const Shell& shell) {
  UnionFind pieces(shell.positions_m.size());
  for (const auto& t : shell.triangles) {
    pieces.unite(t[0], t[1]);
    pieces.unite(t[0], t[2]);
  }
  return std::move(pieces).all();
}

struct Piece {
  double volume_m3 = 0;  ///< signed [m3]
  Eigen::AlignedBox3d box_m;
};

}  // namespace

Eigen::AlignedBox3d filledBounds(const TriangleMesh& mesh) {
  std::vector<Piece> pieces;
  double largest_m3 = 0;
  for (const ClosedSurface& surface : closeSurfaces(mesh)) {
    const Shell& shell = surface.shell;
    if (shell.isOpenSheet()) continue;
    const std::vector<uint32_t> of_vertex = piecesOf(shell);
    std::vector<Piece> own(shell.positions_m.size());
    for (const auto& t : shell.triangles) {
      Piece& piece = own[of_vertex[t[0]]];
      const Vector3d &base = shell.positions_m[of_vertex[t[0]]], &a = shell.positions_m[t[0]];
      const Vector3d area = (shell.positions_m[t[1]] - a).cross(shell.positions_m[t[2]] - a);
      piece.volume_m3 += (a - base).dot(area) / 6;
      for (const uint32_t v : t) piece.box_m.extend(shell.positions_m[v]);
    }
    for (const Piece& piece : own) {
      if (piece.box_m.isEmpty()) continue;
      largest_m3 = std::max(largest_m3, std::abs(piece.volume_m3));
      pieces.push_back(piece);
    }
  }
  Eigen::AlignedBox3d box_m;
  for (const Piece& piece : pieces)
    if (std::abs(piece.volume_m3) >= kCrumb * largest_m3) box_m.extend(piece.box_m);
  if (box_m.isEmpty())
    for (const Vector3f& p : mesh.positions_m) box_m.extend(p.cast<double>());
  return box_m;
}

}  // namespace viscera
