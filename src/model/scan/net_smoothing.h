// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <vector>

#include "model/scan/net_cells.h"

namespace viscera {

struct SmoothingRule {
  int rounds;
  double box;  ///< how far a vertex may go from where it began, along each axis [spacings]
};

/// Makes a net bend as little as its box allows. Each label keeps the volume that is asked for, and walls stay where
/// they were.
/// @param volumes_m3  [256] wanted of each label; that of label 0 is not looked at
/// @return            edges along which four faces of one label meet
size_t smooth(NetCells& net, const Vector3d& spacing_m, const SmoothingRule& rule,
              const std::vector<double>& volumes_m3);

}  // namespace viscera
