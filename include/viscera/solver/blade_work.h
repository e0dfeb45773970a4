// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "viscera/api.h"

namespace VISCERA_PUBLIC viscera {

/// Work of a stylus's blade on tissue that resists it (material.cut, docs/cutting.md).
struct BladeWork {
  double area_m2 = 0;    ///< area cut since the last reset, in the rest shape [m2]
  double work_j = 0;     ///< work of the tool since then, less what the tissue gave back [J]
  double parting_j = 0;  ///< part of it that created the area [J]: toughness carried by the lattice, times area
  double limit_n = 0;    ///< force at which the edge advances, at its pose in the last tick [N]; 0: it is in no tissue
};

}  // namespace viscera
