// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <functional>
#include <vector>

#include "solver/processes/suture/chain/chain.h"
#include "solver/processes/suture/needle.h"
#include "solver/processes/suture/thread_channels.h"
#include "solver/processes/suture/thread_hands.h"
#include "viscera/math/state_hash.h"
#include "viscera/model/scene/stylus_config.h"

namespace viscera {

struct Scene;

/// The needles of a scene, each on the start of a thread, and who leads them: styluses in mode needle.
class Needles {
 public:
  Needles(const Scene& scene, const Model& model);

  using Passes = std::function<void(uint32_t thread, const NeedlePassed&, const ChannelLaw&)>;
  bool empty() const { return needles_.empty(); }
  const Needle* find(size_t thread) const;
  /// The stylus that holds the needle of a thread; kMaxStyluses: none.
  size_t holderOf(size_t thread) const;
  /// Springs were cut.
  void embedAgain(const TissuePoints& tissue);
  /// A stylus that begins takes the nearest needle within its reach, also from another hand.
  void beginTick(const ToolMotions& motions);
  /// A substep of the tissue that was just made.
  /// @param at  of the tick, at the end of the substep   @param obstacles  [count] in it
  /// @param passes  takes places of tissue that the tail has left: they are on the thread now
  void act(TissuePort& target, TissuePoints& tissue, double at, double dt_s, const layout::ObstacleMotion* obstacles,
           uint32_t count, const Passes& passes);
  /// Moves what holds the thread's first node. @param share  of the way of the needle in the substep
  void lay(uint32_t thread, double share, ChainHold& hold) const;
  /// What the thread gave the needle in a substep of its own.
  void takeOver(uint32_t thread, const ChainHold& hold);
  const StylusPulls& pulls() const { return pulls_; }  ///< of the tick so far
  double work_j() const { return work_j_; }            ///< on the tissue, in it

  void reset();
  void persist(Archive& archive);       ///< what rollbacks put back
  void persistHands(Archive& archive);  ///< and what they do not
  void addTo(StateHash& hash) const;

 private:
  struct Held {
    uint32_t stylus = layout::kMaxStyluses;  ///< none
    Pose in_hand;
  };
  struct OnThread {
    uint32_t thread;
    Needle needle;
    Held held;
  };
  void take(uint32_t stylus, const Pose& tip);

  std::vector<StylusConfig> styluses_;
  std::vector<ThreadConfig> threads_;
  const Model& model_;
  Vector3d gravity_;
  double tick_s_;
  ToolMotions motions_;  ///< of the tick
  std::vector<OnThread> needles_;
  std::array<bool, layout::kMaxStyluses> takes_{};
  StylusPulls pulls_;
  double work_j_ = 0;
  std::vector<NeedlePassed> passed_;
};

}  // namespace viscera
