// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <vector>

#include "viscera/api.h"
#include "viscera/math/types.h"

namespace VISCERA_PUBLIC viscera {

/// Object that is drawn as a tube.
enum class TubeKind { kSuture, kNeedle, kClip };

/// Centre line of a suture, of a piece cut from it, of its needle or of a clip.
struct VisibleTube {
  size_t suture = 0;  ///< index of the suture in the scene; 0 for clips
  TubeKind part = TubeKind::kSuture;
  std::vector<Vector3d> positions_m;  ///< [nodes] positions in order, tissue frame [m]; of a needle from its tip on

  bool operator==(const VisibleTube& other) const {
    return suture == other.suture && part == other.part && positions_m == other.positions_m;
  }
};
using VisibleTubes = std::vector<VisibleTube>;

}  // namespace viscera
