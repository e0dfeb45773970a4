// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <vector>

#include "viscera/math/types.h"

namespace viscera {

/// What is drawn as a tube.
enum class ThreadPart { kThread, kNeedle, kClip };

/// Where a thread, a piece that was parted from it, its needle or a clip is.
struct ShownThread {
  size_t thread = 0;  ///< of the scene; of clips 0
  ThreadPart part = ThreadPart::kThread;
  std::vector<Vector3d> places_m;  ///< [nodes] in a row, tissue frame; of a needle from its tip on

  bool operator==(const ShownThread& other) const {
    return thread == other.thread && part == other.part && places_m == other.places_m;
  }
};
using ShownThreads = std::vector<ShownThread>;

}  // namespace viscera
