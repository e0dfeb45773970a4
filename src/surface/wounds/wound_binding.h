// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "surface/wounds/wound_cells.h"
#include "viscera/layout/skin.h"

namespace viscera {

/// Binds a point near a wound to a triangle of lattice nodes on its own side (EGVE 3.3.1 with the constant basis). So
/// both lips are where they were at rest, and each moves with its tissue. The triangle is the nearest one of the cell
/// that has intact edges and nodes connected to the place's node. If there is none, it is one outside the cell at that
/// node. At a node with one intact spring the third node equals the first. At a node without intact springs all three
/// are equal, and the point translates with it.
/// @param point  in cells from the lattice's origin   @param normal  unit, at rest
layout::SkinBinding bindToSide(const CutCells& cells, const Vector3d& point, const Vector3d& normal,
                               const WoundPoint& position);

/// Binds the end of a wound, which both of its sides share, to the nearest triangle of its cell as if it were intact.
layout::SkinBinding bindAcross(const CutCells& cells, const Vector3d& point, const Vector3d& normal,
                               const WoundPoint& position);

/// Binds a point to the triangle of nodes of another binding, so that nothing can fold between the two.
layout::SkinBinding bindLike(const layout::SkinBinding& other, const CutCells& cells, const Vector3d& point,
                             const Vector3d& normal);

/// Changes the shading normal of a binding.
void setNormal(const Vector3d& normal, layout::SkinBinding& binding);

}  // namespace viscera
