// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <vector>

#include "viscera/api.h"
#include "viscera/model/scene/knot_kind.h"

namespace VISCERA_PUBLIC viscera {

/// Knot of a suture.
struct KnotState {
  KnotKind kind = KnotKind::kNone;
  std::vector<int> turns;  ///< signed turns of the throws that tools made
  bool tied = false;       ///< its loop is no longer being drawn, or two throws are made
  double holds_n = 0;      ///< tension above which it slips [N]
  double loop_m = 0;       ///< length of the loop between its two points [m]
  double loop_n = 0;       ///< tension in the loop next to the knot [N]
};

/// Suture, or piece cut from one, after a tick.
struct SutureState {
  size_t suture = 0;  ///< index of the suture in the scene
  double length_m = 0;
  double largest_n = 0;  ///< largest tension of a link [N]
  double turns = 0;      ///< turns of its tails about each other by the tools that hold them, since the last throw
  std::vector<KnotState> knots;
};

}  // namespace viscera
