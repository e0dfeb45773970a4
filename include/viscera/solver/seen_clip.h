// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <vector>

#include "viscera/math/types.h"

namespace viscera {

/// A clip that is on tissue.
struct SeenClip {
  size_t stylus = 0;                   ///< that set it
  Vector3d rest_m = Vector3d::Zero();  ///< middle of what it holds, of the tissue at rest
  double opening_m = 0;                ///< largest distance of two nodes that it holds together
  double force_n = 0;                  ///< with which it holds them, in the last substep
};

/// All clips of a session, and what became of others since the last reset.
struct SeenClips {
  std::vector<SeenClip> on;
  size_t empty = 0;      ///< closed on nothing
  size_t taken_off = 0;  ///< by blades
};

}  // namespace viscera
