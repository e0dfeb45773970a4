// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <vector>

#include "viscera/math/types.h"
#include "viscera/model/scene/knot_kind.h"

namespace viscera {

/// Nodes in a row.
struct Strand {
  const Vector3d* nodes;
  size_t count;
};

/// Gauss's integral of two strands: signed turns of one about the other, right-handed above 0. Exact for their straight
/// pieces; a whole number only where their ends are far apart.
double turnsOf(const Strand& one, const Strand& other);

/// Whole turns of a throw with their sign; 0: it is none yet.
int throwOf(double turns);

/// @param throws  one after the other, in whole turns; those of 0 are passed over
KnotKind kindOf(const std::vector<int>& throws);
}  // namespace viscera
