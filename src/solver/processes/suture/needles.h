// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <functional>
#include <vector>

#include "solver/processes/suture/chain/chain.h"
#include "solver/processes/suture/needle.h"
#include "solver/processes/suture/suture_grips.h"
#include "solver/processes/suture/suture_tracks.h"
#include "viscera/math/state_hash.h"
#include "viscera/model/scene/stylus_config.h"

namespace viscera {

struct Scene;

/// The needles of a scene, each at the start of a suture, and the styluses in mode needle that lead them.
class Needles {
 public:
  Needles(const Scene& scene, const Model& model);

  using Passes = std::function<void(uint32_t suture, const NeedlePassed&, const TrackLaw&)>;
  bool empty() const { return needles_.empty(); }
  const Needle* find(size_t suture) const;
  /// Returns the stylus that holds the needle of a suture; kMaxStyluses: none.
  size_t holderOf(size_t suture) const;
  /// Updates the needles after springs were cut.
  void embedAgain(const TissuePoints& tissue);
  /// Lets a stylus that starts take the nearest needle within its reach, also from another stylus.
  void beginTick(const ToolMotions& motions);
  /// Acts after a substep of the tissue.
  /// @param at  share of the tick at the end of the substep   @param obstacles  [count] in it
  /// @param passes  receives points of tissue that the tail has left: they are on the suture from now on
  void act(TissuePort& target, TissuePoints& tissue, double at, double dt_s, const layout::ObstacleMotion* obstacles,
           uint32_t count, const Passes& passes);
  /// Moves the hold on the suture's first node. @param share  of the needle's displacement in the substep
  void lay(uint32_t suture, double share, ChainHold& hold) const;
  /// Takes the impulse of the suture on the needle in a substep of the suture.
  void takeOver(uint32_t suture, const ChainHold& hold);
  const StylusPulls& pulls() const { return pulls_; }  ///< pulls in the tick so far
  double work_j() const { return work_j_; }            ///< work on the tissue in it

  void reset();
  void persist(Archive& archive);       ///< state that roll-backs restore
  void persistTools(Archive& archive);  ///< state that they do not
  void addTo(StateHash& hash) const;

 private:
  struct Held {
    uint32_t stylus = layout::kMaxStyluses;  ///< kMaxStyluses: none
    Pose in_grip;
  };
  struct OnThread {
    uint32_t suture;
    Needle needle;
    Held held;
  };
  void take(uint32_t stylus, const Pose& tip);

  std::vector<StylusConfig> styluses_;
  std::vector<SutureConfig> sutures_;
  const Model& model_;
  Vector3d gravity_;
  double tick_s_;
  ToolMotions motions_;  ///< motions in the tick
  std::vector<OnThread> needles_;
  std::array<bool, layout::kMaxStyluses> takes_{};
  StylusPulls pulls_;
  double work_j_ = 0;
  std::vector<NeedlePassed> passed_;
};

}  // namespace viscera
