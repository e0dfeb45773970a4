// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "solver/processes/suture/chain/chain.h"
#include "solver/processes/suture/suture_skin.h"
#include "viscera/layout/obstacle_motion.h"

namespace viscera {

/// Distance of a position from an obstacle's surface, and the outward normal.
struct ObstacleSide {
  double distance_m;  ///< negative: inside
  Vector3d normal;
};
/// Returns the side at the end of a substep, tissue frame.
ObstacleSide sideOf(const layout::ObstacleMotion& obstacle, const Vector3d& position_m);

/// The surface, for the nodes of a chain that are not in tissue.
struct NearTracks {
  const SutureSkin* skin = nullptr;
  double low = 0, high = 0;  ///< outer channels on the chain [links]; nodes between or within a link of them are exempt
};

/// The contacts of a chain with obstacles and surface, as half spaces: tangent planes at the points nearest to each
/// node.
class SutureContacts {
 public:
  /// Finds the contacts of nearby nodes. Contacts that existed in the last substep keep their state.
  /// @param obstacles  over the next substep   @param touches  in: of the last substep; out: of this one
  void find(const Chain& chain, const layout::ObstacleMotion* obstacles, uint32_t count, const NearTracks& beside,
            double dt_s, std::vector<ChainTouch>& touches);
  /// Adds contacts of nodes that jumped into an obstacle from farther away: they stay on the side from which they came.
  /// Where the chain is pressed into what it touches, all contacts are placed again.
  /// @param ends_m  end positions of all nodes   @returns whether there were any
  bool catchUp(const Chain& chain, const layout::ObstacleMotion* obstacles, uint32_t count, double dt_s,
               const std::vector<Vector3d>& ends_m, std::vector<ChainTouch>& touches);

 private:
  using Number = std::pair<uint32_t, uint32_t>;  ///< node, thing
  ChainTouch knownAs(const Number& number, std::vector<ChainTouch>::const_iterator& kept) const;
  bool layAgain(const Chain& chain, const layout::ObstacleMotion* obstacles, uint32_t count, double dt_s,
                const std::vector<Vector3d>& ends_m, std::vector<ChainTouch>& touches);

  std::vector<ChainTouch> before_;
  int laid_ = 0;  ///< times placed again in this substep
};

}  // namespace viscera
