// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
// clang-format off
// Constants of the hyperelastic law (physics.md 1), shared by shaders/solver/tissue/law.glsl, its SIMD version and the float64 reference.
#ifndef VISCERA_LAYOUT_LAW_H
#define VISCERA_LAYOUT_LAW_H
#include "viscera/layout/types.h"

#ifdef __cplusplus
namespace viscera::layout {
#endif

// Volume ratio J below which the law continues with bounded derivatives: 1/J stays constant, so an inverted cell is pushed back with a
// bounded pressure. No cell of 200 random starts with displacements of 0.3 h came below it.
const float kLeastVolume = 0.2f;
// Largest exponent of the stiffening law. Shear resists at most exp(3) = 20 times as much as at rest, so steps stay finite.
const float kMostExponent = 3.0f;
// Largest stiffening() that is evaluated: beyond it a cell is crushed, and the stability monitor handles it.
const float kMostStiffening = 1e4f;
// Newton steps for the jump of the gradient between two materials in a cell. Three keep positions within 1e-4 of the reference's after a
// substep from random displacements of 0.3 h (NeoHookean.LayersAtLargeStrainsMatchTheReference).
const int kLaminateSteps = 3;
// Resistance to the alternating mode: 5/36 mu h^3 |H_xyz|^2, as of the hexahedron.
const float kLawAlternating = 5.0f / 18.0f;
// Share that is kept of the stress across a thin wall due to the gradient of strain within a cell: the wall is free to thin.
const float kRowStressAcross = 0.1f;
// Additional vectors per node with cells in thin walls, one per axis: those of the row of nodes that it is in (row_forces.comp).
const uint kRowVectors = 3u;
// Vectors that a cell in a thin wall stores for these rows: derivatives by its second differences along x, y, z, then by their variation,
// ordered by axis of the row and axis of the sides: xy, xz, yz, yx, zx, zy.
const uint kWallVectors = 9u;

#ifdef __cplusplus
}  // namespace viscera::layout
#endif
#endif
