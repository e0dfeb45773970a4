// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "solver/processes/process.h"
#include "solver/processes/suture/chain/chain.h"
#include "solver/processes/suture/needles.h"
#include "solver/processes/suture/thread_blades.h"
#include "solver/processes/suture/thread_hands.h"
#include "solver/processes/suture/thread_piece.h"
#include "solver/processes/suture/wound_lips.h"
#include "solver/processes/tissue_points.h"
#include "viscera/model/model.h"
#include "viscera/model/scene/environment_config.h"
#include "viscera/solver/seen_needle.h"

namespace viscera {

struct Scene;

/// How well threads kept their lengths since they were made, beside their state: for measurements.
struct ThreadLinks {
  uint64_t substeps = 0, off = 0;  ///< of all threads; those after which a link was off by more than a thousandth
  double worst = 0;                ///< relative error of a length
  double iterations = 0;           ///< of all substeps
  uint64_t waits = 0;              ///< substeps without a solution, in which a thread stayed where it was
};

/// All threads of a scene with their needles. Threads that are tied to tissue are stepped after each of its substeps
/// (docs/thread.md 5), the others at the end of a tick, in substeps of their own.
class ThreadBodies : public TissueProcess {
 public:
  /// @param model  must outlive them; null: there is no tissue   @throws SceneError  channels that there cannot be
  explicit ThreadBodies(const Scene& scene, const Model* model = nullptr);

  RollBack rollBack() const override { return RollBack::kUndo; }
  bool readsCuts() const override { return tissue_ != nullptr; }
  void cutsChanged(const CutSprings& cuts) override;
  /// Moves what the tissue carries.
  void beginTick(const ProcessTick& tick) override;
  bool act(TissuePort& port, const ProcessTick& tick, const ProcessSubstep& substep) override;
  bool endTick(TissuePort& port, const ProcessTick& tick, const TissueProcesses& all) override;
  /// A tick without tissue.
  void step(const ToolMotions& motions, const ObstacleMotions& obstacles);
  void addPulls(StylusPulls& pulls) const override;
  double work_j() const override { return work_j_; }

  void reset() override;
  void persist(Archive& archive) override;
  void persistUndone(Archive& archive) override;
  /// What hands hold is not put back.
  void undone(bool at_rest) override;
  bool addTo(StateHash& hash) const override;
  FactGroup facts() const override;
  void draw(ProcessLook& look) const override;

  /// Brings the tails of a piece together and ties them. @param piece  < count()
  /// @throws Error  there is no such piece, or why it cannot be tied
  void tie(size_t piece, const ThreadTie& tie);

  /// Threads of the scene, and behind them what was parted from them.
  size_t count() const { return pieces_.size(); }
  const ThreadPiece& piece(size_t at) const { return pieces_[at]; }
  const Chain& chain(size_t at) const { return pieces_[at].chain; }
  const Needle* needle(size_t thread) const { return needles_ ? needles_->find(thread) : nullptr; }
  size_t needleHolder(size_t thread) const { return needles_ ? needles_->holderOf(thread) : layout::kMaxStyluses; }
  std::vector<SeenNeedle> seenNeedles() const;  ///< of the threads that have one
  const std::vector<ChainSlide>& slides(size_t at) const { return pieces_[at].around.slides; }
  const ThreadLinks& links() const { return links_; }
  const std::string& refused() const { return refused_; }  ///< why the last of ThreadConfig::ties was not tied

 private:
  /// The substeps of a tick.
  struct Steps {
    int count = 1;
    std::vector<layout::ObstacleMotion> ways;  ///< [count * kMaxObstacles]
  };
  void plan(Steps& steps, int count, const ObstacleMotions& obstacles) const;
  void substep(uint32_t thread, const Steps& steps, int index);
  void noteLinks(const Chain& chain);
  const layout::ObstacleMotion* obstaclesOf(const Steps& steps, int index) const;
  bool anyTied() const;
  std::vector<const TissuePoint*> tiedPoints() const;
  void moveNeedles(TissuePort& port, int index);
  void stepLoose();
  void tieWhatIsDue();
  void partWhatBladesMet();
  /// @returns whether it was
  bool part(uint32_t piece, size_t node);

  const Model* model_;
  std::vector<std::string> names_;  ///< [threads of the scene]
  std::vector<ObstacleConfig> obstacles_;
  double tick_s_;
  bool can_cut_;
  std::unique_ptr<TissuePoints> tissue_;  ///< null: none is tied to it
  WoundLips lips_;
  ThreadHands hands_;
  std::optional<Needles> needles_;  ///< only where threads are tied
  ThreadBlades blades_;
  std::vector<std::vector<ThreadTie>> ties_;  ///< [threads of the scene]
  std::vector<ThreadPiece> first_, pieces_;   ///< as the scene has them, and now
  Steps alone_, tied_;
  int per_substep_ = 1;  ///< of the tissue, so many of tied threads
  double work_j_ = 0;
  uint64_t tick_ = 0;  ///< under way, since the start or the last reset
  std::string refused_;
  ThreadLinks links_;
};

}  // namespace viscera
