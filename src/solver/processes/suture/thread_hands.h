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

/// Styluses that hold threads: in mode grab, two neighbours each, for a direction.
class ThreadHands {
 public:
  explicit ThreadHands(const std::vector<StylusConfig>& styluses) : styluses_(styluses) {}

  /// A stylus that begins to grab takes the nearest node within its reach, and the one behind it.
  void beginTick(const ToolMotions& motions, const std::vector<const Chain*>& threads);
  /// Adds what it holds of a thread. @param at  of the tick, at the end of the substep
  void addHolds(uint32_t thread, double at, std::vector<ChainHold>& holds) const;
  /// Takes over what a substep made of these. @param first  of those of addHolds()
  void takeOver(uint32_t thread, const std::vector<ChainHold>& holds, size_t first);
  const StylusPulls& pulls() const { return pulls_; }    ///< of the tick so far
  std::vector<uint32_t> nodesOf(uint32_t thread) const;  ///< that they hold, the first of each
  /// What is behind a node of a thread is another one from now on.
  void parted(uint32_t thread, uint32_t node, uint32_t behind);
  /// Lets go what is not there any more. @param nodes  [threads]
  void letGoMissing(const std::vector<size_t>& nodes);
  void reset() { grips_ = {}; }
  void persist(Archive& archive);

 private:
  struct Grip {
    uint32_t thread = 0, node = 0;
    bool holds = false;
    std::array<Vector3d, 2> places_m;  ///< in the stylus's frame
    std::array<double, 2> stiffness_kg;
  };
  static void takeHold(Grip& grip, const Pose& tip, double reach_m, const std::vector<const Chain*>& threads);

  std::vector<StylusConfig> styluses_;
  ToolMotions motions_;  ///< of the tick
  std::array<Grip, layout::kMaxStyluses> grips_;
  StylusPulls pulls_;
};

}  // namespace viscera
