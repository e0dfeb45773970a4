// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "viscera/model/shape/triangle_mesh.h"

namespace viscera {

/// Part of a mesh, or several joined parts, made into a closed surface: every point off it has an integer winding
/// number.
struct Shell {
  std::vector<Vector3d> positions_m;
  std::vector<std::array<uint32_t, 3>> triangles;  ///< the part's own triangles, then the caps
  std::vector<bool> turned;        ///< [own triangles] whether the triangle was turned to agree with its neighbours
  std::vector<uint32_t> vertices;  ///< [own vertices, before those of the caps] index in the mesh
  std::vector<bool> closes_hole;   ///< [caps] whether the loop has some area: slits are closed too
  int holes_closed = 0;            ///< number of capped boundary loops with some area
  double own_area_m2 = 0;
  double cap_area_m2 = 0;
  double volume_m3 = 0;  ///< signed [m3]; negative where the part is inside out

  /// Returns whether the surface is more hole than wall, such as a plane or a shallow bowl: it has no inside.
  bool isOpenSheet() const { return cap_area_m2 > kMostCapArea * own_area_m2; }
  Vector3d min() const;
  Vector3d max() const;

  /// Area of the caps over area of the part up to which holes count as damage; a half sphere has 0.5.
  static constexpr double kMostCapArea = 0.6;
};

/// Returns the triangles of every part, in the order of the mesh.
std::vector<std::vector<uint32_t>> trianglesByPart(const TriangleMesh& mesh);

/// Orients the triangles of one part alike across shared edges, and caps their boundary loops.
/// @param same  [vertices] replacement of each vertex of the mesh; empty: itself
Shell closePart(const TriangleMesh& mesh, const std::vector<uint32_t>& of_part, const std::vector<uint32_t>& same = {});

/// Returns the surface of a box in a frame of its own.
Shell boxShell(const Vector3d& min_m, const Vector3d& max_m, const Pose& pose);

/// Returns the mesh with its triangles counter-clockwise seen from outside, surface by surface (closeSurfaces()). Parts
/// of one surface share the vertices where they meet.
TriangleMesh facingOutward(const TriangleMesh& mesh);

/// Returns the mesh with the caps of closeSurfaces(), except those of open sheets: the surface of the filled region.
/// @param mesh  facing outward
TriangleMesh withCaps(const TriangleMesh& mesh);

}  // namespace viscera
