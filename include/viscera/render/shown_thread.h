// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <vector>

#include "viscera/math/types.h"

namespace viscera {

/// Where a thread, a piece that was parted from it, or its needle is.
struct ShownThread {
  size_t thread = 0;  ///< of the scene
  bool needle = false;
  std::vector<Vector3d> places_m;  ///< [nodes] in a row, tissue frame; of a needle from its tip on

  bool operator==(const ShownThread& other) const {
    return thread == other.thread && needle == other.needle && places_m == other.places_m;
  }
};
using ShownThreads = std::vector<ShownThread>;

}  // namespace viscera
