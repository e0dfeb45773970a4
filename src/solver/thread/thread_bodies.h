// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "math/archive.h"
#include "solver/thread/chain/chain.h"
#include "solver/thread/needles.h"
#include "solver/thread/thread_channels.h"
#include "solver/thread/thread_hands.h"
#include "solver/thread/thread_touches.h"
#include "solver/thread/tissue_points.h"
#include "solver/thread/wound_lips.h"
#include "viscera/model/model.h"
#include "viscera/model/scene/scene.h"
#include "viscera/tools/obstacles.h"
#include "viscera/tools/stylus.h"

namespace viscera {

/// All threads of a scene. Those that are tied to tissue are stepped after each of its substeps (docs/thread.md 5), the
/// others at the end of a tick, in substeps of their own.
class ThreadBodies {
 public:
  /// @param model  must outlive them; null: there is no tissue   @param good_states  that are kept for rollbacks
  /// @throws SceneError  channels that there cannot be
  explicit ThreadBodies(const Scene& scene, const Model* model = nullptr, int good_states = 0);

  /// Are threads tied to tissue, now or later?
  bool feelTissue() const { return tissue_ != nullptr; }
  /// Springs that are cut, only where they feel it.
  void setCuts(const Model& model, const CutSprings& cuts);

  /// @param motions  of the tick, as solvers take them   @param obstacles  of the scene, over the tick
  /// @param substeps  of the tissue
  void beginTick(const ToolMotions& motions, const ObstacleMotions& obstacles, int substeps);
  /// After a substep of the tissue. @returns whether springs were cut
  bool act(BladeTarget& target, int substep);
  void endTick();
  /// A tick without tissue.
  void step(const ToolMotions& motions, const ObstacleMotions& obstacles);
  ThreadPulls pulls() const;                 ///< of the tick
  double work_j() const { return work_j_; }  ///< done on the tissue in the tick

  void reset();
  void persist(Archive& archive);
  /// @name As SolverBackend has them; what hands hold is not put back
  /// @{
  void saveGood();
  void restoreGood(int back);
  void clearGood() { good_.clear(); }
  /// @}
  /// Fingerprint of a state of the tissue and of all threads in it.
  uint64_t hashWith(uint64_t tissue) const;

  size_t count() const { return threads_.size(); }
  const Chain& chain(size_t thread) const { return threads_[thread].chain; }
  const Needle* needle(size_t thread) const { return needles_ ? needles_->find(thread) : nullptr; }
  const std::vector<ChainSlide>& slides(size_t thread) const { return threads_[thread].around.slides; }

 private:
  struct Thread {
    Chain chain;
    ChainAround around;  ///< holds: those of fixed ends, then those of hands
    size_t fixed_holds;
    ThreadTouches touches;
    ThreadChannels channels, first_channels;
    std::vector<ChainSlide> first_slides;
    bool tied = false;  ///< in this tick
  };
  /// The substeps of a tick.
  struct Steps {
    int count = 1;
    std::vector<layout::ObstacleMotion> ways;  ///< [count * kMaxObstacles]
  };
  void persistMotion(Archive& archive);
  void plan(Steps& steps, int count, const ObstacleMotions& obstacles) const;
  void substep(uint32_t thread, const Steps& steps, int index);
  const layout::ObstacleMotion* obstaclesOf(const Steps& steps, int index) const;
  std::vector<const TissuePoint*> tiedPoints() const;
  void moveNeedles(BladeTarget& target, int index);

  std::vector<ObstacleConfig> obstacles_;
  double tick_s_;
  bool can_cut_;
  std::unique_ptr<TissuePoints> tissue_;  ///< null: none is tied to it
  WoundLips lips_;
  ThreadHands hands_;
  std::optional<Needles> needles_;  ///< only where there are some
  std::vector<Thread> threads_;
  Steps alone_, tied_;
  int per_substep_ = 1;  ///< of the tissue, so many of tied threads
  double work_j_ = 0;
  size_t good_states_;
  std::vector<std::vector<Archive::Section>> good_;  ///< oldest first
};

}  // namespace viscera
