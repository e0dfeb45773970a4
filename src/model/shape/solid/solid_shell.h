// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "viscera/model/shape/triangle_mesh.h"

namespace viscera {

/// A part of a mesh, or several that are joined, made into a closed surface: every point off it has a whole winding
/// number.
struct Shell {
  std::vector<Vector3d> positions_m;
  std::vector<std::array<uint32_t, 3>> triangles;  ///< the part's own first, then the caps
  std::vector<bool> turned;        ///< [own triangles] whether it was turned to agree with its neighbours
  std::vector<uint32_t> vertices;  ///< [own vertices, before those of the caps] in the mesh
  std::vector<bool> closes_hole;   ///< [caps] whether its loop has some area: slits are closed too
  int holes_closed = 0;            ///< boundary loops that were capped with some area
  double own_area_m2 = 0;
  double cap_area_m2 = 0;
  double volume_m3 = 0;  ///< signed; negative where the part is inside out

  /// A surface that is more hole than wall, such as a plane or a shallow bowl, has no inside.
  bool isOpenSheet() const { return cap_area_m2 > kMostCapArea * own_area_m2; }
  Vector3d min() const;
  Vector3d max() const;

  /// Area of the caps over area of the part up to which its holes count as damage; a half sphere has 0.5.
  static constexpr double kMostCapArea = 0.6;
};

/// The triangles of every part, in the order of the mesh.
std::vector<std::vector<uint32_t>> trianglesByPart(const TriangleMesh& mesh);

/// Orients some triangles of a mesh, those of one part, alike across shared edges and caps their boundary loops.
/// @param same  [vertices] which vertex of the mesh to take for each; empty: itself
Shell closePart(const TriangleMesh& mesh, const std::vector<uint32_t>& of_part, const std::vector<uint32_t>& same = {});

/// The surface of a box in a frame of its own.
Shell boxShell(const Vector3d& min_m, const Vector3d& max_m, const Pose& pose);

/// The mesh with its triangles turned to be counter-clockwise seen from outside, surface by surface (closeSurfaces()).
/// Parts that are one surface share the vertices where they meet.
TriangleMesh facingOutward(const TriangleMesh& mesh);

/// The mesh with the caps that closeSurfaces() puts on its holes, but of open sheets: the surface of what is filled.
/// @param mesh  facing outward
TriangleMesh withCaps(const TriangleMesh& mesh);

}  // namespace viscera
