// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Solids and meshes small enough to reason about, for the tests of the surface mesh.
#pragma once

#include <array>
#include <cmath>
#include <limits>
#include <map>

#include "viscera/model/body/lattice.h"
#include "viscera/model/body/skin.h"
#include "viscera/model/shape/triangle_mesh.h"

namespace viscera::testing {

/// Returns the cells of a grid with a centre that satisfies a predicate.
template <class Inside>
Solid solidWhere(const Vector3d& origin_m, const Vector3i& cells, double spacing_m, Inside inside) {
  Solid solid;
  solid.origin_m = origin_m;
  solid.cells = cells;
  solid.spacing_m = spacing_m;
  solid.part_names = {"tissue"};
  solid.labels.assign(static_cast<size_t>(cells.prod()), 0);
  for (int z = 0; z < cells.z(); ++z)
    for (int y = 0; y < cells.y(); ++y)
      for (int x = 0; x < cells.x(); ++x) {
        const Vector3d center = origin_m + spacing_m * (Vector3d(x, y, z) + Vector3d::Constant(0.5));
        solid.labels[solid.index(x, y, z)] = inside(center) ? 1 : 0;
      }
  return solid;
}

/// Returns a box of whole cells from the origin.
inline Solid blockSolid(const Vector3i& cells, double spacing_m, const Vector3d& origin_m = Vector3d::Zero()) {
  return solidWhere(origin_m, cells, spacing_m, [](const Vector3d&) { return true; });
}

/// Returns a ball of cells.
inline Solid ballSolid(const Vector3d& center_m, double radius_m, double spacing_m) {
  const int cells = 2 * static_cast<int>(std::ceil(radius_m / spacing_m)) + 2;
  const Vector3d origin = center_m - Vector3d::Constant(0.5 * cells * spacing_m);
  return solidWhere(origin, Vector3i::Constant(cells), spacing_m,
                    [&](const Vector3d& at) { return (at - center_m).norm() < radius_m; });
}

/// Returns a grid of 2 n^2 triangles over a parallelogram; the normal is side1 x side2.
inline TriangleMesh sheetMesh(const Vector3d& corner_m, const Vector3d& side1_m, const Vector3d& side2_m, int n) {
  TriangleMesh mesh;
  mesh.part_names = {"tissue"};
  for (int j = 0; j <= n; ++j)
    for (int i = 0; i <= n; ++i) {
      mesh.positions_m.push_back((corner_m + side1_m * i / n + side2_m * j / n).cast<float>());
    }
  for (uint32_t j = 0; j < static_cast<uint32_t>(n); ++j)
    for (uint32_t i = 0; i < static_cast<uint32_t>(n); ++i) {
      const uint32_t a = i + (static_cast<uint32_t>(n) + 1) * j, b = a + 1, d = a + static_cast<uint32_t>(n) + 1;
      mesh.triangles.push_back({a, b, d + 1});
      mesh.triangles.push_back({a, d + 1, d});
    }
  mesh.parts.assign(mesh.triangles.size(), 0);
  return mesh;
}

inline void append(TriangleMesh& mesh, const TriangleMesh& more) {
  const auto first = static_cast<uint32_t>(mesh.positions_m.size());
  mesh.positions_m.insert(mesh.positions_m.end(), more.positions_m.begin(), more.positions_m.end());
  for (const auto& t : more.triangles) mesh.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
  mesh.parts.insert(mesh.parts.end(), more.parts.begin(), more.parts.end());
  mesh.part_names = more.part_names;
}

/// Returns six sheets around a box, facing outward, not welded at its edges.
inline TriangleMesh boxMesh(const Vector3d& min_m, const Vector3d& max_m, int n) {
  TriangleMesh mesh;
  const Vector3d size = max_m - min_m;
  for (int axis = 0; axis < 3; ++axis) {
    const Vector3d u = size.cwiseProduct(Vector3d::Unit((axis + 1) % 3));
    const Vector3d v = size.cwiseProduct(Vector3d::Unit((axis + 2) % 3));
    append(mesh, sheetMesh(min_m, v, u, n));
    append(mesh, sheetMesh(min_m + size.cwiseProduct(Vector3d::Unit(axis)), u, v, n));
  }
  return mesh;
}

/// Returns a cube's six faces, n^2 squares each, projected onto a sphere.
inline TriangleMesh sphereMesh(const Vector3d& center_m, double radius_m, int n) {
  TriangleMesh mesh = boxMesh(-Vector3d::Ones(), Vector3d::Ones(), n);
  for (Vector3f& p : mesh.positions_m) {
    p = (center_m + radius_m * p.cast<double>().normalized()).cast<float>();
  }
  return mesh;
}

/// Returns the same as one closed surface.
inline TriangleMesh weldedSphereMesh(const Vector3d& center_m, double radius_m, int n) {
  const TriangleMesh sheets = sphereMesh(center_m, radius_m, n);
  TriangleMesh mesh = sheets;
  mesh.positions_m.clear();
  std::map<std::array<int64_t, 3>, uint32_t> known;
  const double apart_m = 1e-4 * radius_m;  // less than the distance of vertices, more than rounding
  std::vector<uint32_t> index;
  for (const Vector3f& p : sheets.positions_m) {
    const auto next = static_cast<uint32_t>(mesh.positions_m.size());
    const Vector3d at = (p.cast<double>() - center_m) / apart_m;
    const auto [found, is_new] =
        known.try_emplace({std::llround(at.x()), std::llround(at.y()), std::llround(at.z())}, next);
    if (is_new) mesh.positions_m.push_back(p);
    index.push_back(found->second);
  }
  for (auto& t : mesh.triangles) t = {index[t[0]], index[t[1]], index[t[2]]};
  return mesh;
}

struct BoundSkin {
  Solid solid;
  Lattice lattice;
  Skin skin;
};

/// Binds a surface mesh to the lattice of a solid.
inline BoundSkin bindTo(const Solid& solid, const TriangleMesh& mesh, Weights weights = Weights::kCell) {
  BoundSkin bound{solid, buildLattice(solid, weights), {}};
  bound.skin = bindSkin(mesh, bound.lattice, bound.solid);
  return bound;
}

/// Returns the largest coordinate of a mesh [m]: float rounding is relative to it.
inline double largestCoordinate(const TriangleMesh& mesh) {
  double largest = 0;
  for (const Vector3f& p : mesh.positions_m) largest = std::max<double>(largest, p.cwiseAbs().maxCoeff());
  return largest;
}

/// Erases from both ends every spring with ends that a predicate (of the rest position) separates, and marks the ends.
template <class Side>
void cutBetween(const Lattice& lattice, Side side, std::vector<layout::NodeBits>& nodes) {
  for (uint32_t slot : lattice.active_slots) {
    for (uint32_t spring = 0; spring < layout::kSpringsPerNode; ++spring) {
      if (!springCount(nodes[slot], spring)) continue;
      const auto other = static_cast<uint32_t>(lattice.neighborSlot(slot, spring));
      if (side(lattice.restPosition(slot)) == side(lattice.restPosition(other))) continue;
      setSpringCount(nodes[slot], spring, 0);
      nodes[slot].lo |= layout::kSeveredBit;
      setSpringCount(nodes[other], oppositeSpring(spring), 0);
      nodes[other].lo |= layout::kSeveredBit;
    }
  }
}

}  // namespace viscera::testing
