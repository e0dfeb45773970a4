// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <vector>

#include "viscera/math/types.h"
#include "viscera/model/scene/knot_kind.h"

namespace viscera {

/// Consecutive nodes.
struct Strand {
  const Vector3d* nodes;
  size_t count;
};

/// Returns Gauss's linking integral of two strands: signed turns of one about the other, positive if right-handed.
/// Exact for their straight segments; an integer only if their ends are far apart.
double turnsOf(const Strand& one, const Strand& other);

/// Returns the whole turns of a throw, signed; 0: not a throw yet.
int throwOf(double turns);

/// Returns the kind of knot. @param throws  in order, in whole turns; zeros are skipped
KnotKind kindOf(const std::vector<int>& throws);
}  // namespace viscera
