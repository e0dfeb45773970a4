// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include "viscera/model/model.h"

namespace viscera {

/// Returns springs along the edges of a triangle mesh, each once: k = E t A / l^2, with A the area of all triangles at
/// the edge. Masses are rho t A / 3, with A the area at the vertex. An isotropic sheet of equilateral triangles then
/// has Young's modulus E exactly (k = sqrt(3)/2 E t) and Poisson's ratio 1/3. Slots are the mesh's vertices; those
/// without a triangle have no mass and are no nodes.
/// @param bending_ratio  above 0: adds springs between the two vertices opposite to an edge for every pair of triangles
///                       at it, with this share of the edge's k, at rest in the mesh's shape. They also stiffen the
///                       sheet in its plane.
/// @param degenerate     counts triangles without area or with a repeated vertex, which are left out
SpringNetwork membraneNetwork(const TriangleMesh& mesh, const MaterialConfig& material, double thickness_m,
                              double bending_ratio = 0, size_t* degenerate = nullptr);

/// Returns the lattice of a body as explicit connections (VR05 2.5.1). Springs and masses equal, as floats, those that
/// the kernels compute from the counts in NodeBits.
/// @param bending_ratio  above 0: adds springs of two spacings along regions one cell thick, straight on and along both
///                       diagonals of the sheet, with this share of the weaker k of the two springs that they span. A
///                       sheet's node has 9 k around it and gets up to 4 k bending_ratio more. The stable substep
///                       (physics.md 2) shrinks by up to sqrt(9 / (9 + 4 bending_ratio)), 0.83 at 1.
SpringNetwork latticeNetwork(const Body& body, double bending_ratio = 0);

/// Returns the network with its nodes in the order of a space-filling curve (Morton) through their rest positions,
/// without slots that are no nodes, and with slots that fill whole bricks.
/// @param slot_of_node  [slots before] new slot of each node; UINT32_MAX: it was no node
SpringNetwork renumbered(const SpringNetwork& network, std::vector<uint32_t>* slot_of_node = nullptr);

/// Returns the slots of a renumbered network: bricks without positions, active slots, and NodeBits with the number of
/// links.
Lattice slotsOfNetwork(const SpringNetwork& network);

/// Gives a body a network of structure surface: renumbered, with slots. Returns `slot_of_node`.
std::vector<uint32_t> adoptNetwork(const SpringNetwork& network, Body& body);

}  // namespace viscera
