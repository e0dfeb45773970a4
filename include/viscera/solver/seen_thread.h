// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <vector>

#include "viscera/model/scene/knot_kind.h"

namespace viscera {

/// A knot of a thread.
struct SeenKnot {
  KnotKind kind = KnotKind::kNone;
  std::vector<int> turns;  ///< of the throws that hands made, by their sign
  bool tied = false;       ///< its loop is not drawn any more, or two throws are made
  double holds_n = 0;      ///< slips at more
  double loop_m = 0;       ///< length of thread between its two points
  double loop_n = 0;       ///< tension in that, beside the knot
};

/// A thread, or a piece that was parted from one, after a tick.
struct SeenThread {
  size_t thread = 0;  ///< of the scene
  double length_m = 0;
  double largest_n = 0;  ///< tension of the link that pulls most
  double turns = 0;      ///< of its tails about each other, by the hands that hold them, since the last throw
  std::vector<SeenKnot> knots;
};

}  // namespace viscera
