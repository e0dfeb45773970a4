// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "solver/processes/tissue_points.h"
#include "viscera/solver/state.h"

namespace viscera {

class Needle;
struct ThreadPiece;

/// Tissue that is put elsewhere between two ticks, as unfolding does: where its points were and are.
class TissueJump {
 public:
  struct Step {
    Vector3d from_m, to_m, velocity_m_per_s;  ///< velocity: afterwards
  };
  /// All of them must outlive it. @param before_m  [slots] displacements
  TissueJump(const TissuePoints& points, const std::vector<layout::vec4>& before_m, const HostState& after)
      : points_(points), before_m_(before_m), after_(after) {}
  Step of(const TissuePoint& point) const;

 private:
  const TissuePoints& points_;
  const std::vector<layout::vec4>& before_m_;
  const HostState& after_;
};

/// Moves a piece of a thread with the tissue that its channels are in. Between channels the chain goes as they do, and
/// less and less along its tails. It takes the velocity of the tissue, and links keep their lengths.
/// @param needle  on its start, where it is now; null: there is none
void carry(const TissueJump& jump, const Needle* needle, ThreadPiece& piece);

}  // namespace viscera
