// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "viscera/layout/types.h"
#include "viscera/model/model.h"
#include "viscera/solver/material.h"

namespace viscera {

// The lattices of all bodies of a model as one, as every backend holds them: the slots of body b follow those of the
// bodies before it.

/// Returns [active] slots of nodes, ascending.
std::vector<uint32_t> activeSlots(const Model& model);
/// Returns [active] these and the ghosts of rows (RowGhost), ascending.
std::vector<uint32_t> movingSlots(const Model& model);
/// Returns [cells] slots of the lowest corners of filled cells, ascending.
std::vector<uint32_t> cellSlots(const Model& model);
/// Returns [bricks] with neighbours numbered over all bodies.
std::vector<layout::Brick> allBricks(const Model& model);
/// Returns [slots] nodes with whole springs, nothing held, and the body's index.
std::vector<layout::NodeBits> allNodes(const Model& model);
/// Returns strengths() of all bodies: spring_n_per_m [9 * slots], mass_kg [slots], bulk_j [slots], rigidity_j [slots].
Strengths allStrengths(const Model& model);

constexpr size_t kVectorsPerFill = 3;

/// Moments of the cells of all bodies over their shares (shaders/solver/tissue/cell_modes.glsl).
struct JoinedMoments {
  std::vector<uint32_t> of_cell;  ///< [slots] index of the moments of the cell above a node; 0: those of a full cell
  /// [kVectorsPerFill * fills] xyz: moments of p; of its squares; of yz, zx, xy. Then stresses of cells, over mu: xx,
  /// yy, zz; yz, zx, xy. Then laminates: normal and share_a; rigidity_a, rigidity_b, K/mu of a and of b. Then cells in
  /// thin walls: normal and rows; variation. w of p: index of the cell's laminate, 0 none; w of its squares: index of
  /// its wall, 0 none.
  std::vector<layout::vec4> vectors;
  std::vector<uint32_t> stress_of_cell;  ///< [slots] index in vectors of a cell's prestress, 0 none; empty without

  void add(const CellFill& fill);
  /// Returns a cell's prestress; null: it has none.
  const layout::vec4* stressOf(uint32_t slot) const {
    const uint32_t at = stress_of_cell.empty() ? 0 : stress_of_cell[slot];
    return at == 0 ? nullptr : &vectors[at];
  }
  /// Returns the wall of a cell in a thin wall; null: it is in none.
  const layout::vec4* wallOf(uint32_t slot) const {
    const auto at = static_cast<size_t>(vectors[kVectorsPerFill * of_cell[slot] + 1].w);
    return at == 0 ? nullptr : &vectors[at];
  }
  /// Returns the laminate of a cell with two materials; null: it has one material.
  const layout::vec4* laminateOf(uint32_t slot) const {
    const auto at = static_cast<size_t>(vectors[kVectorsPerFill * of_cell[slot]].w);
    return at == 0 ? nullptr : &vectors[at];
  }
};
JoinedMoments allMoments(const Model& model);
/// Returns whether there are cells in thin walls (wallCells()).
bool hasWalls(const Model& model);
/// Returns whether a body with a law has a prestress.
bool hasCellPrestress(const Model& model);
/// Returns whether there are cells of a law with two materials (cellLaminates()).
bool hasLaminates(const Model& model);

/// Returns [slots] depths of nodes below the surface of their tissue [m], negative outside, for tools and obstacles.
/// They are given in bodies with partially filled cells, for nodes less than half a cell deep; 0 elsewhere. Empty
/// without such bodies. Contact with deeper nodes ignores the depth: the tissue above them would act as if rigid.
std::vector<float> surfaceDepths(const Model& model);

/// Returns how far from a probe the end nodes of springs may be that it touches between their ends [m]: the longest
/// spring, stretched by 0.41.
float edgeReach(const Model& model);

/// Returns [slots] displacements from nodes outside their tissue to its surface, one word each
/// (shaders/layout/surface_offsets.h); empty if no body has partially filled cells.
std::vector<uint32_t> surfaceOffsets(const Model& model);

}  // namespace viscera
