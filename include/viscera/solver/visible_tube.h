// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <vector>

#include "viscera/api.h"
#include "viscera/math/types.h"

namespace VISCERA_PUBLIC viscera {

/// Object that is drawn as a tube.
enum class TubeKind { kSuture, kNeedle, kClip, kStrand };
/// Most strands of connective tissue that are drawn at once.
constexpr size_t kMostStrands = 256;
constexpr size_t kStrandNodes = 5;

/// Centre line of a suture, of a piece cut from it, of its needle, of a clip or of a strand.
struct VisibleTube {
  size_t suture = 0;  ///< index of the suture in the scene; 0 for clips and strands
  TubeKind part = TubeKind::kSuture;
  std::vector<Vector3d> positions_m;  ///< [nodes] positions in order, tissue frame [m]; of a needle from its tip on
  double waist = 1;                   ///< radius in the middle over that at the ends, of strands

  bool operator==(const VisibleTube& other) const {
    return suture == other.suture && part == other.part && positions_m == other.positions_m && waist == other.waist;
  }
};
using VisibleTubes = std::vector<VisibleTube>;

}  // namespace viscera
