// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
// clang-format off
// Constants of the hyperelastic law (physics.md 1): of shaders/solver/tissue/law.glsl, its SIMD twin and the float64 reference.
#ifndef VISCERA_LAYOUT_LAW_H
#define VISCERA_LAYOUT_LAW_H
#include "viscera/layout/types.h"

#ifdef __cplusplus
namespace viscera::layout {
#endif

// Volume ratio J below which the law goes on with bounded derivatives: 1/J stays constant, so that a cell that is turned inside out is
// pushed back with a bounded pressure. No cell of 200 random starts with displacements of 0.3 h came below it.
const float kLeastVolume = 0.2f;
// Largest exponent of the stiffening law: shear resists exp(3) = 20 times as much as at rest at most, so that steps stay finite.
const float kMostExponent = 3.0f;
// Largest stiffening() that is looked at: beyond it a cell is crushed, and the stability monitor's affair.
const float kMostStiffening = 1e4f;
// Steps of Newton's method for the jump of the gradient between two materials in a cell. Three keep positions within 1e-4 of the
// reference's after a substep from random displacements of 0.3 h (NeoHookean.LayersAtLargeStrainsMatchTheReference).
const int kLaminateSteps = 3;
// What resists the alternating motion: 5/36 mu h^3 |H_xyz|^2, the hexahedron's.
const float kLawAlternating = 5.0f / 18.0f;
// Stress across a thin wall that the gradient of strain within a cell leaves, as a share: the wall is free to thin.
const float kRowStressAcross = 0.1f;
// With cells in thin walls a node has one vector per axis more than kCellVectors: of the row of nodes that it is in (row_forces.comp).
const uint kRowVectors = 3u;
// Vectors that a cell in a thin wall leaves for these: by its second derivatives along x, y, z, and by their variation, by axis of the
// row and axis of the sides xy, xz, yz, yx, zx, zy.
const uint kWallVectors = 9u;

#ifdef __cplusplus
}  // namespace viscera::layout
#endif
#endif
