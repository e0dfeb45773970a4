// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "viscera/model/model.h"

namespace viscera {

// material.prestress (docs/physics.md 11) of a body with its nodes fixed already. As much of it is kept as balances in
// the body's shape; a note says how much. Does nothing without a prestress.

/// Sets the stress at rest of the cells of a lattice that obeys a law (Body::prestress).
/// @throws SceneError  requirePrestrains(), PrestressBalance::find()
void addCellPrestress(Body& body);

/// Sets the rest lengths of a sheet's springs.   @throws SceneError  as addCellPrestress()
void addSheetPrestress(Body& body);

}  // namespace viscera
