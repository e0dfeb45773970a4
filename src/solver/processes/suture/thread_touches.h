// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "solver/processes/suture/chain/chain.h"
#include "solver/processes/suture/thread_skin.h"
#include "viscera/layout/obstacle_motion.h"

namespace viscera {

/// How far a place is from an obstacle's border, and which way is out.
struct ObstacleSide {
  double distance_m;  ///< below 0: inside
  Vector3d normal;
};
/// At the end of a substep, tissue frame.
ObstacleSide sideOf(const layout::ObstacleMotion& obstacle, const Vector3d& place_m);

/// The skin for those nodes of a chain that are not in tissue.
struct BesideChannels {
  const ThreadSkin* skin = nullptr;
  double low = 0, high = 0;  ///< outer channels, on the chain [links]: within a link of them and between it is left out
};

/// The touches of a chain with obstacles and skin, as half spaces: tangents of what is nearest to each node.
class ThreadTouches {
 public:
  /// Of the nodes that are near. What the last substep's touches keep, they keep.
  /// @param obstacles  over the substep to come   @param touches  of the last substep, and then of this
  void find(const Chain& chain, const layout::ObstacleMotion* obstacles, uint32_t count, const BesideChannels& beside,
            double dt_s, std::vector<ChainTouch>& touches);
  /// Of nodes that were jerked into an obstacle from farther away: they stay on the side from which they came. Where
  /// the chain is pressed into what it touches, all that touch are laid again.
  /// @param ends_m  of all nodes   @returns whether there were any
  bool catchUp(const Chain& chain, const layout::ObstacleMotion* obstacles, uint32_t count, double dt_s,
               const std::vector<Vector3d>& ends_m, std::vector<ChainTouch>& touches);

 private:
  using Number = std::pair<uint32_t, uint32_t>;  ///< node, thing
  ChainTouch knownAs(const Number& number, std::vector<ChainTouch>::const_iterator& kept) const;
  bool layAgain(const Chain& chain, const layout::ObstacleMotion* obstacles, uint32_t count, double dt_s,
                const std::vector<Vector3d>& ends_m, std::vector<ChainTouch>& touches);

  std::vector<ChainTouch> before_;
  int laid_ = 0;  ///< again, in this substep
};

}  // namespace viscera
