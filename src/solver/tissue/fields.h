// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "viscera/math/types.h"

namespace viscera {

/// One vector per slot, in float64: displacements [m], velocities [m/s], forces [N]. Zero in slots without a node.
using Field = std::vector<Vector3d>;

double largestNorm(const Field& field);       ///< length of its longest vector; 0 if empty
double largestComponent(const Field& field);  ///< largest magnitude of any component; 0 if empty

}  // namespace viscera
