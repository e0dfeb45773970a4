// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <vector>

#include "viscera/api.h"
#include "viscera/math/types.h"

namespace VISCERA_PUBLIC viscera {

/// Clip on tissue.
struct ClipState {
  size_t stylus = 0;                   ///< index of the stylus that set it
  Vector3d rest_m = Vector3d::Zero();  ///< centre of the held tissue, in the rest shape [m]
  double opening_m = 0;                ///< largest distance of two nodes that it holds together [m]
  double force_n = 0;                  ///< force with which it holds them, in the last substep [N]
};

/// All clips of a session, and the number of others since the last reset.
struct ClipStates {
  std::vector<ClipState> on;
  size_t empty = 0;      ///< number of clips that closed on nothing
  size_t taken_off = 0;  ///< number of clips that blades removed
};

}  // namespace viscera
