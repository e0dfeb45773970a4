// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "viscera/model/model.h"

namespace viscera {

// material.prestress (docs/cutting.md 6) of a body whose nodes are fixed already: as much of it as balances in the
// shape that the body has; a note says how much. Without a prestress nothing is done.

/// Gives the cells of a lattice that obeys a law their stress at rest (Body::prestress).
/// @throws SceneError  requirePrestrains(), PrestressBalance::find()
void addCellPrestress(Body& body);

/// Gives the springs of a sheet their rest lengths.   @throws SceneError  as addCellPrestress()
void addSheetPrestress(Body& body);

}  // namespace viscera
