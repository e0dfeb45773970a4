// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <vector>

#include "solver/processes/stylus_pull.h"
#include "solver/processes/suture/chain/chain.h"
#include "viscera/model/scene/stylus_config.h"
#include "viscera/tools/stylus.h"

namespace viscera {

class Archive;

/// Styluses that hold sutures: in mode grab, each by two neighbouring nodes, which fix a direction.
class SutureGrips {
 public:
  explicit SutureGrips(const std::vector<StylusConfig>& styluses) : styluses_(styluses) {}

  /// Lets a stylus that starts to grab take the nearest node within its reach, and the one behind it.
  void beginTick(const ToolMotions& motions, const std::vector<const Chain*>& sutures);
  /// Adds its holds of a suture. @param at  share of the tick at the end of the substep
  void addHolds(uint32_t suture, double at, std::vector<ChainHold>& holds) const;
  /// Takes the result of a substep for these holds. @param first  index of the first one of addHolds()
  void takeOver(uint32_t suture, const std::vector<ChainHold>& holds, size_t first);
  const StylusPulls& pulls() const { return pulls_; }    ///< pulls in the tick so far
  std::vector<uint32_t> nodesOf(uint32_t suture) const;  ///< first node of each grip
  /// Updates grips after a suture was cut at a node: what is behind is another suture.
  void parted(uint32_t suture, uint32_t node, uint32_t behind);
  /// Releases nodes that no longer exist. @param nodes  [sutures]
  void letGoMissing(const std::vector<size_t>& nodes);
  void reset() { grips_ = {}; }
  void persist(Archive& archive);

 private:
  struct Grip {
    uint32_t suture = 0, node = 0;
    bool holds = false;
    std::array<Vector3d, 2> positions_m;  ///< positions in the stylus's frame
    std::array<double, 2> stiffness_kg;
  };
  static void takeHold(Grip& grip, const Pose& tip, double reach_m, const std::vector<const Chain*>& sutures);

  std::vector<StylusConfig> styluses_;
  ToolMotions motions_;  ///< motions in the tick
  std::array<Grip, layout::kMaxStyluses> grips_;
  StylusPulls pulls_;
};

}  // namespace viscera
