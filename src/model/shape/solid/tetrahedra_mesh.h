// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "viscera/model/shape/solid.h"

namespace viscera {

/// Tetrahedra with shared vertices. Positive volume: the corners 1, 2, 3 turn counter-clockwise seen from corner 0's
/// far side, as in Gmsh and VTK.
struct TetrahedraMesh {
  std::vector<Vector3d> positions_m;                ///< [vertices]
  std::vector<std::array<uint32_t, 4>> tetrahedra;  ///< [tetrahedra] vertex indices
};

/// Six times the signed volume of a tetrahedron, over six [m3].
double signedVolume(const TetrahedraMesh& mesh, const std::array<uint32_t, 4>& tetrahedron);

/// Five tetrahedra per filled cell, mirrored from cell to cell so that they meet: one regular tetrahedron in the middle
/// and one at each corner that it leaves.
TetrahedraMesh tetrahedraOf(const Solid& solid);

}  // namespace viscera
