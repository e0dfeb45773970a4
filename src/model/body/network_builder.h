// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include "viscera/model/model.h"

namespace viscera {

/// Springs along the edges of a triangle mesh, each once: k = E t A / l^2, A the area of all triangles at the edge, and
/// masses of rho t A / 3, A of those at the vertex. An isotropic sheet of equilateral triangles so has Young's modulus
/// E exactly (k = sqrt(3)/2 E t) and Poisson's ratio 1/3. Slots are the mesh's vertices; those without a triangle have
/// no mass and are no nodes.
/// @param bending_ratio  above 0: springs between the two vertices opposite to an edge, this share of the edge's k, for
///                       every pair of triangles at it; at rest as the mesh is. They stiffen the sheet in its plane
///                       too.
/// @param degenerate     counts triangles without area or with a repeated vertex, which are left out
SpringNetwork membraneNetwork(const TriangleMesh& mesh, const MaterialConfig& material, double thickness_m,
                              double bending_ratio = 0, size_t* degenerate = nullptr);

/// The lattice of a body as explicit connections (VR05 2.5.1): springs and masses are, as floats, those that the
/// kernels make of the counts in NodeBits.
/// @param bending_ratio  above 0: springs of two spacings along parts that are one cell thick, straight on and along
///                       both diagonals of the sheet, this share of the k of the weaker of the two springs that they
///                       span. A sheet's node has 9 k around it and gets up to 4 k bending_ratio more: the stable
///                       substep (physics.md 2) shrinks by up to sqrt(9 / (9 + 4 bending_ratio)), 0.83 at 1.
SpringNetwork latticeNetwork(const Body& body, double bending_ratio = 0);

/// The network with its nodes in the order of a space-filling curve (Morton) through their rest positions, without what
/// is no node, and with slots that fill whole bricks.
/// @param slot_of_node  [slots before] where each node went; UINT32_MAX: it was none
SpringNetwork renumbered(const SpringNetwork& network, std::vector<uint32_t>* slot_of_node = nullptr);

/// The slots of a renumbered network: bricks that lie nowhere, active slots, and NodeBits with the number of links.
Lattice slotsOfNetwork(const SpringNetwork& network);

/// Gives a body a network of structure surface: renumbered, with slots. Returns `slot_of_node`.
std::vector<uint32_t> adoptNetwork(const SpringNetwork& network, Body& body);

}  // namespace viscera
