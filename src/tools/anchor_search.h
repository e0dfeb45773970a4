// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "viscera/tools/strokes.h"

namespace viscera {

/// Returns the axes of an anchor's own frame: z back along its ray, x horizontal, y upwards.
Quaterniond frameAlong(const Vector3d& back);

/// Returns whether a vertex of a body's surface mesh is bound to fixed nodes only.
bool isHeld(const Body& body, uint32_t vertex);

/// Returns the shift [m] across its ray that moves an anchor, made for another organ, onto this one, which may be
/// narrower, hollow, fixed or absent there. The shift maximises the number of stroke spots above tissue that can move,
/// then above any tissue, then the thickness of the tissue below them, as far as the strokes go; of equal shifts it is
/// the smallest. @param spots_m  where the strokes touch, in the anchor's frame
Vector3d shiftOntoSkin(const Model& model, const Anchor& anchor, const std::vector<Vector3d>& spots_m);

}  // namespace viscera
