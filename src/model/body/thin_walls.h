// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "viscera/model/body/elasticity.h"

namespace viscera {

/// Of the cells that lie in walls of few cells, what their corners do not show of a bend (physics.md 1, Thin walls):
/// the second differences along the cell's own axes that cost the tissue around it least, faded out with the wall's
/// thickness and as far as the cell's highest frequency stays within what dt_safe assumes.
/// @param moments  of the body's cells   @return ascending by cell
/// @throws SceneError  as strengths()
std::vector<CellBend> cellBends(const Body& body, const CellMoments& moments);

/// Share of the cells in part that lie in walls of less than kFewCells, of some two thousand of them; 0: none is in
/// part.
double thinShare(const Lattice& lattice);
constexpr double kFewCells = 2.5;  ///< where what is missed of a bend by cells alone is 5 % or more

}  // namespace viscera
