// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "viscera/model/shape/triangle_mesh.h"

namespace viscera::cli {

/// Returns a strokes file for the two styluses of an imported scene. The left stylus dents the largest organ and pulls
/// it; the right one cuts it and opens the cut. They act in the middle of the organ's visible front, clear of all other
/// organs.
/// @param organs     surfaces in the frame of the scan, the largest at `largest`
/// @param is_held    [triangles of the largest] fixed positions, which styluses avoid if possible
/// @param moved_m    translation from the scan to the scene [m]
/// @param most_size  largest scale of the motions, as for the scene's tools: 1 for an organ of 0.1 m
std::string strokesFor(const std::vector<const TriangleMesh*>& organs, size_t largest, const std::vector<bool>& is_held,
                       const Vector3d& moved_m, double most_size);

}  // namespace viscera::cli
