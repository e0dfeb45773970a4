// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "viscera/model/shape/triangle_mesh.h"

namespace viscera::cli {

/// A strokes file for the two styluses of an imported scene: the left hand dents the largest organ and pulls it, the
/// right hand cuts it and opens the cut. Where: in the middle of what is seen of it from before, past all other organs.
/// @param organs     where the scan has them, the largest at `largest`
/// @param is_held    [triangles of the largest] places that cannot move, which hands go to only if there are no others
/// @param moved_m    from there to the scene
/// @param most_size  of hands' ways, as tools of the scene: 1 for an organ of 0.1 m
std::string strokesFor(const std::vector<const TriangleMesh*>& organs, size_t largest, const std::vector<bool>& is_held,
                       const Vector3d& moved_m, double most_size);

}  // namespace viscera::cli
