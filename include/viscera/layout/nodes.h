// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
// clang-format off
// Nodes, the bricks that store them, and the constants of a body.
#ifndef VISCERA_LAYOUT_NODES_H
#define VISCERA_LAYOUT_NODES_H
#include "viscera/layout/types.h"
#include "viscera/layout/limits.h"

#ifdef __cplusplus
namespace VISCERA_PUBLIC viscera { namespace layout {
#endif

// NodeBits.lo: six axial counts of 3 bits (quarters of the axial stiffness, 0..4), then:
const uint kMassShift = 18u;  // 4 bits: number of solid cells around the node, 1..8, each an eighth of a cell's mass
const uint kFixedBit = 1u << 22; // fixed in space
const uint kGrabShift = 23u;     // 2 bits: 0 free, 1 + stylus index while held
const uint kGrabMask = 3u << 23;
const uint kSeveredBit = 1u << 25; // at least one spring of this node was cut
const uint kCellBit = 1u << 26;  // the cell that has this node as its lowest corner is filled and whole
const uint kLawCellBit = 1u << 27;  // that cell obeyed its body's hyperelastic law at rest; once it is no longer whole, its remaining springs act
const uint kGhostRowShift = 28u;  // 3 bits, one per axis: the row of nodes along it ends here, at a ghost (RowGhost); of a ghost: the spring index towards its fixed node
const uint kGhostBit = 1u << 31; // the slot is a ghost: it has kFixedBit, no springs and no mass of its own
const uint kAxialMask = (1u << 18) - 1u;
// NodeBits.hi: twelve diagonal counts of 2 bits (halves of the diagonal stiffness, 0..2), then the body index:
const uint kBodyShift = 24u;
const uint kDiagonalMask = (1u << 24) - 1u;

struct NodeBits {
  uint lo;
  uint hi;
};

struct Brick {
  int coord_x, coord_y, coord_z;  // coordinates of the brick, in bricks from its body's node (0, 0, 0)
  uint body;
  uint neighbors[27];  // index of the neighbouring brick at (dx+1) + 3 (dy+1) + 9 (dz+1); this brick's own index where there is none
  uint pad;
};
const uint kBrickWords = 32u;
const uint kBrickNeighborWord = 4u;  // word of Brick.neighbors[0]

// Largest (L^2 - l0^2) / l0^2 of a spring of length L at which its force may use the predicted positions of its ends (physics.md 2).
const float kMildStretch = 0.125f;

struct BodyParams {
  vec4 origin_spacing;      // xyz: rest position of node (0, 0, 0) [m, tissue frame]; w: spacing h [m]
  float axial_quarter_n_per_m;  // quarter of the axial stiffness: what one solid cell adds to an edge
  float diagonal_half_n_per_m;  // half of the diagonal stiffness: what one solid cell adds to a face diagonal
  float mass_eighth_kg;
  float mass_damping_per_s;  // mass-proportional damping rate gamma [1/s]
  float dashpot_s;          // axial dashpot coefficient over spring stiffness, c/k [s]
  float bulk_j;  // (lambda - mu) h^3 of cells that obey the law [J]; 0 in bodies of springs
  uint connections;         // kImplicit, kExplicitLattice or kNetwork
  float rigidity_j;  // mu h^3 [J]; 0 in bodies of springs
  uint law;                 // kLawSprings or kLawNeoHookean
  float stiffening;  // b of the exponential in the neo-Hookean law (law.glsl); 0: none
  uint pad_x, pad_y;  // pads to whole vectors, as std140 pads arrays of structs
};
// Law of a body's cells: springs, or a neo-Hookean energy (law.glsl), where springs act only in cells that have lost a spring.
const uint kLawSprings = 0u;
const uint kLawNeoHookean = 1u;
// Connections of a body: lattice springs by offset, with counts in NodeBits; the same lattice with its springs as links; or any
// graph of links, where the low 18 bits of NodeBits.lo count the intact links of a node.
const uint kImplicit = 0u;
const uint kExplicitLattice = 1u;
const uint kNetwork = 2u;
// Number of vectors that cell_forces.comp writes for a cell with a law: its force on each corner. A node reads one from each cell around it.
const uint kCellVectors = 8u;
const uint kValenceMask = kAxialMask;

#ifdef __cplusplus
}}  // namespace viscera::layout
#endif
#endif
