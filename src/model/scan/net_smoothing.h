// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <vector>

#include "model/scan/net_cells.h"

namespace viscera {

struct SmoothingRule {
  int rounds;
  double box;  ///< largest distance of a vertex from its start, along each axis [spacings]
};

/// Smooths a net so that it bends as little as its box allows. Each label keeps its requested volume, and walls keep
/// their positions.
/// @param volumes_m3  [256] requested volume of each label; that of label 0 is ignored
/// @return            number of edges along which four faces of one label meet
size_t smooth(NetCells& net, const Vector3d& spacing_m, const SmoothingRule& rule,
              const std::vector<double>& volumes_m3);

}  // namespace viscera
