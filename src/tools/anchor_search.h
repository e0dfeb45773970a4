// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "viscera/tools/strokes.h"

namespace viscera {

/// Axes of an anchor's own frame: z back along its ray, x horizontal, y upwards.
Quaterniond frameAlong(const Vector3d& back);

/// Is a vertex of a body's skin bound to nodes that are all held in space?
bool isHeld(const Body& body, uint32_t vertex);

/// An anchor that was made for another organ, beside which this one may be narrow, hollow, held or not there: by how
/// much to move it across its ray, so that skin that can move lies under as many of the strokes' spots as anywhere,
/// then skin at all; the least that does.
/// @param spots_m  where the strokes touch, in the anchor's frame; only x and y count
Vector3d shiftOntoSkin(const Model& model, const Anchor& anchor, const std::vector<Vector3d>& spots_m);

}  // namespace viscera
