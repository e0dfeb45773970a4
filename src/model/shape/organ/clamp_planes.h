// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "viscera/model/scene/body_config.h"
#include "viscera/model/shape/solid.h"

namespace viscera {

/// Returns the planes where a body is fixed: per axis of the lattice the first plane of its fixed regions that is
/// parallel to the lattice and bounds what is fixed. This is a plane, or a face of a box within the body. Nodes on it
/// fix the body exactly there; otherwise the clamp would be off by up to half a cell, as large an error as any of the
/// cells.
/// @param bounds  of the body, tissue frame
NodePlanes clampPlanes(const BodyConfig& config, const Eigen::AlignedBox3d& bounds);

}  // namespace viscera
