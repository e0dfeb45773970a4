// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "math/archive.h"
#include "solver/thread/chain/chain.h"
#include "solver/thread/clips.h"
#include "solver/thread/needles.h"
#include "solver/thread/thread_blades.h"
#include "solver/thread/thread_hands.h"
#include "solver/thread/thread_piece.h"
#include "solver/thread/tissue_points.h"
#include "solver/thread/wound_lips.h"
#include "viscera/model/model.h"
#include "viscera/tools/obstacles.h"
#include "viscera/tools/stylus.h"

namespace viscera {

struct Scene;

/// How well threads kept their lengths since they were made, beside their state: for measurements.
struct ThreadLinks {
  uint64_t substeps = 0, off = 0;  ///< of all threads; those after which a link was off by more than a thousandth
  double worst = 0;                ///< relative error of a length
  double iterations = 0;           ///< of all substeps
  uint64_t waits = 0;              ///< substeps without a solution, in which a thread stayed where it was
};

/// All threads of a scene, and clips. Threads that are tied to tissue are stepped after each of its substeps
/// (docs/thread.md 5), the others at the end of a tick, in substeps of their own.
class ThreadBodies {
 public:
  /// @param model  must outlive them; null: there is no tissue   @param good_states  that are kept for rollbacks
  /// @throws SceneError  channels that there cannot be
  explicit ThreadBodies(const Scene& scene, const Model* model = nullptr, int good_states = 0);

  /// Are threads or clips tied to tissue, now or later?
  bool feelTissue() const { return tissue_ != nullptr; }
  /// Springs that are cut, only where they feel it.
  void setCuts(const Model& model, const CutSprings& cuts);

  /// Tissue was put elsewhere between two ticks: moves what it carries. @param before_m  [slots] displacements
  void carry(const std::vector<layout::vec4>& before_m, const HostState& after);

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

  /// Brings the tails of a piece together and ties them. @param piece  < count()
  /// @throws Error  there is no such piece, or why it cannot be tied
  void tie(size_t piece, const ThreadTie& tie);

  /// Threads of the scene, and behind them what was parted from them.
  size_t count() const { return pieces_.size(); }
  const ThreadPiece& piece(size_t at) const { return pieces_[at]; }
  const Chain& chain(size_t at) const { return pieces_[at].chain; }
  const Needle* needle(size_t thread) const { return needles_ ? needles_->find(thread) : nullptr; }
  size_t needleHolder(size_t thread) const { return needles_ ? needles_->holderOf(thread) : layout::kMaxStyluses; }
  const Clips* clips() const { return clips_ ? &*clips_ : nullptr; }  ///< null: no stylus sets any
  const std::vector<ChainSlide>& slides(size_t at) const { return pieces_[at].around.slides; }
  const ThreadLinks& links() const { return links_; }
  const std::string& refused() const { return refused_; }  ///< why the last of ThreadConfig::ties was not tied

 private:
  /// The substeps of a tick.
  struct Steps {
    int count = 1;
    std::vector<layout::ObstacleMotion> ways;  ///< [count * kMaxObstacles]
  };
  void persistMotion(Archive& archive);
  void plan(Steps& steps, int count, const ObstacleMotions& obstacles) const;
  void substep(uint32_t thread, const Steps& steps, int index);
  void noteLinks(const Chain& chain);
  const layout::ObstacleMotion* obstaclesOf(const Steps& steps, int index) const;
  bool anyTied() const;
  std::vector<const TissuePoint*> tiedPoints() const;
  void moveNeedles(BladeTarget& target, int index);
  void tieWhatIsDue();
  void partWhatBladesMet();
  void takeOffWhatBladesMet();
  /// @returns whether it was
  bool part(uint32_t piece, size_t node);

  const Model* model_;
  std::vector<ObstacleConfig> obstacles_;
  double tick_s_;
  bool can_cut_;
  std::unique_ptr<TissuePoints> tissue_;  ///< null: none is tied to it
  WoundLips lips_;
  ThreadHands hands_;
  std::optional<Needles> needles_;  ///< only where threads are tied
  std::optional<Clips> clips_;      ///< only where a stylus sets them
  ThreadBlades blades_;
  std::vector<std::vector<ThreadTie>> ties_;  ///< [threads of the scene]
  std::vector<ThreadPiece> first_, pieces_;   ///< as the scene has them, and now
  Steps alone_, tied_;
  int per_substep_ = 1;  ///< of the tissue, so many of tied threads
  double work_j_ = 0;
  uint64_t tick_ = 0;  ///< under way, since the start or the last reset
  std::string refused_;
  ThreadLinks links_;
  size_t good_states_;
  std::vector<std::vector<Archive::Section>> good_;  ///< oldest first
};

}  // namespace viscera
