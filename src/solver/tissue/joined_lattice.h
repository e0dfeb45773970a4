// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "viscera/layout/types.h"
#include "viscera/model/model.h"
#include "viscera/solver/material.h"

namespace viscera {

// The lattices of all bodies of a model as one, as every backend holds it: slots of body b behind those of the bodies
// before it.

/// [active] slots of nodes, ascending
std::vector<uint32_t> activeSlots(const Model& model);
/// [cells] slots of the lowest corners of filled cells, ascending
std::vector<uint32_t> cellSlots(const Model& model);
/// [bricks] neighbours numbered over all bodies
std::vector<layout::Brick> allBricks(const Model& model);
/// [slots] whole springs, nothing held, with the body's index
std::vector<layout::NodeBits> allNodes(const Model& model);
/// strengths() of all bodies: spring_n_per_m [9 * slots], mass_kg [slots], bulk_j [slots], rigidity_j [slots]
Strengths allStrengths(const Model& model);

constexpr size_t kVectorsPerFill = 3;

/// Moments of the cells of all bodies over their shares (shaders/solver/tissue/cell_motion.glsl).
struct JoinedMoments {
  std::vector<uint32_t> of_cell;         ///< [slots] which moments the cell above a node has; 0: those of a full one
  std::vector<layout::vec4> vectors;     ///< [kVectorsPerFill * fills] xyz: of p; of its squares; of yz, zx, xy; then
                                         ///< stresses of cells, over mu: xx, yy, zz; yz, zx, xy; then laminates:
                                         ///< normal and share_a; rigidity_a, rigidity_b, K/mu of a and of b; then
                                         ///< cells in thin walls: normal and rows; variation. w of p: where the cell's
                                         ///< laminate is, 0 none; w of its squares: where its wall is, 0 none
  std::vector<uint32_t> stress_of_cell;  ///< [slots] where in vectors a cell's prestress is, 0 none; empty without

  void add(const CellFill& fill);
  /// Where a cell's prestress is; null: it has none.
  const layout::vec4* stressOf(uint32_t slot) const {
    const uint32_t at = stress_of_cell.empty() ? 0 : stress_of_cell[slot];
    return at == 0 ? nullptr : &vectors[at];
  }
  /// Where the wall of a cell in a thin one is; null: it is in none.
  const layout::vec4* wallOf(uint32_t slot) const {
    const auto at = static_cast<size_t>(vectors[kVectorsPerFill * of_cell[slot] + 1].w);
    return at == 0 ? nullptr : &vectors[at];
  }
  /// Where the laminate of a cell of two materials is; null: it has one material.
  const layout::vec4* laminateOf(uint32_t slot) const {
    const auto at = static_cast<size_t>(vectors[kVectorsPerFill * of_cell[slot]].w);
    return at == 0 ? nullptr : &vectors[at];
  }
};
JoinedMoments allMoments(const Model& model);
/// Are there cells in thin walls (wallCells())?
bool hasWalls(const Model& model);
/// Has a body of a law a prestress?
bool hasCellPrestress(const Model& model);
/// Are there cells of a law that two materials share (cellLaminates())?
bool hasLaminates(const Model& model);

/// [slots] how deep nodes lie below the surface of their tissue [m], negative outside, where tools and obstacles are to
/// know it: in bodies with cells that are tissue in part, of nodes less than half a cell deep; 0 elsewhere. Empty
/// without such bodies. Deeper nodes are met as they are: the tissue above them would be as if it were rigid.
std::vector<float> surfaceDepths(const Model& model);

/// How far beyond a probe nodes of springs may be that it touches between their ends [m]: the longest spring, stretched
/// by 0.41.
float edgeReach(const Model& model);

/// [slots] from nodes outside of their tissue to its surface, a word each (shaders/layout/surface_ways.h); empty where
/// no body has cells that are tissue in part.
std::vector<uint32_t> surfaceWays(const Model& model);

}  // namespace viscera
