// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "viscera/model/shape/solid.h"

namespace viscera {

/// Volume over that of the largest piece, below which a separate piece is a crumb.
constexpr double kCrumb = 1e-3;

/// Empties the pieces of a solid that touch no other, not even at a corner, and have less tissue than a share of the
/// largest. Returns the number of pieces removed.
int removeCrumbs(Solid& solid, double least_share);

}  // namespace viscera
