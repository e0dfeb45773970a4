// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "viscera/model/shape/solid.h"

namespace viscera {

/// Empties the pieces of a solid that touch no other, not even at a corner, and are smaller than a share of the
/// largest. Returns the number of pieces removed.
int removeCrumbs(Solid& solid, double least_share);

}  // namespace viscera
