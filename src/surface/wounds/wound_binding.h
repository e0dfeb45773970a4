// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "surface/wounds/wound_cells.h"
#include "viscera/layout/skin.h"

namespace viscera {

/// Binds a point beside a wound to a triangle of lattice nodes of its own side (EGVE 3.3.1 with the constant basis), so
/// that both lips are where they were at rest and go each with its tissue. The triangle is the nearest one of its
/// cell's whose edges are whole and whose nodes hang together with the place's node; where there is none, one beyond
/// the cell at that node; at a node with one whole spring the third node is the first, at one with none all three are:
/// the point goes with it unturned.
/// @param point  in cells from the lattice's origin   @param normal  unit, at rest
layout::SkinBinding bindToSide(const CutCells& cells, const Vector3d& point, const Vector3d& normal,
                               const WoundPlace& place);

/// Binds the end of a wound, which is of both its sides, to the nearest triangle of its cell as if it were whole.
layout::SkinBinding bindAcross(const CutCells& cells, const Vector3d& point, const Vector3d& normal,
                               const WoundPlace& place);

/// Binds a point to the triangle of nodes that carries another one: between the two nothing can fold.
layout::SkinBinding bindLike(const layout::SkinBinding& other, const CutCells& cells, const Vector3d& point,
                             const Vector3d& normal);

/// Changes the shading normal of a binding.
void setNormal(const Vector3d& normal, layout::SkinBinding& binding);

}  // namespace viscera
