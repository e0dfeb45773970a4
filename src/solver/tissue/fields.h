// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "viscera/math/types.h"

namespace viscera {

/// One vector per slot, in float64: displacements [m], velocities [m/s], forces [N]. Zero where no node is.
using Field = std::vector<Vector3d>;

double largestNorm(const Field& field);       ///< longest of its vectors; 0 of none
double largestComponent(const Field& field);  ///< largest magnitude of any of their components; 0 of none

}  // namespace viscera
