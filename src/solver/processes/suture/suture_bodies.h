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
#include "solver/processes/suture/suture_blades.h"
#include "solver/processes/suture/suture_grips.h"
#include "solver/processes/suture/suture_piece.h"
#include "solver/processes/suture/wound_lips.h"
#include "solver/processes/tissue_points.h"
#include "viscera/model/model.h"
#include "viscera/model/scene/environment_config.h"
#include "viscera/solver/needle_state.h"

namespace viscera {

struct Scene;

/// Statistics of how well sutures have kept their lengths since they were made; not part of the state.
struct SutureLinks {
  uint64_t substeps = 0, off = 0;  ///< substeps of all sutures; those with a link off by more than a thousandth
  double worst = 0;                ///< relative error of a length
  double iterations = 0;           ///< sum over all substeps
  uint64_t waits = 0;              ///< substeps without a solution, in which a suture did not move
};

/// All sutures of a scene with their needles. Sutures in tissue are stepped after each of its substeps (docs/physics.md
/// 15), the others at the end of a tick, in substeps of their own.
class SutureBodies : public TissueProcess {
 public:
  /// @param model  must outlive them; null: there is no tissue   @throws SceneError  invalid channels
  explicit SutureBodies(const Scene& scene, const Model* model = nullptr);

  RollBack rollBack() const override { return RollBack::kUndo; }
  bool readsCuts() const override { return tissue_ != nullptr; }
  void cutsChanged(const CutSprings& cuts) override;
  /// Moves the tissue points of the channels.
  void beginTick(const ProcessTick& tick) override;
  bool act(TissuePort& port, const ProcessTick& tick, const ProcessSubstep& substep) override;
  bool endTick(TissuePort& port, const ProcessTick& tick, const TissueProcesses& all) override;
  /// Advances by a tick without tissue.
  void step(const ToolMotions& motions, const ObstacleMotions& obstacles);
  void addPulls(StylusPulls& pulls) const override;
  double work_j() const override { return work_j_; }

  void reset() override;
  void persist(Archive& archive) override;
  void persistUndone(Archive& archive) override;
  /// Grips are not restored.
  void undone(bool at_rest) override;
  bool addTo(StateHash& hash) const override;
  FactGroup facts() const override;
  void draw(ProcessVisuals& visuals) const override;

  /// Brings the tails of a piece together and ties them. @param piece  < count()
  /// @throws Error  there is no such piece, or the reason why it cannot be tied
  void tie(size_t piece, const SutureTie& tie);

  /// Returns the number of sutures of the scene and of the pieces cut from them, which follow.
  size_t count() const { return pieces_.size(); }
  const SuturePiece& piece(size_t at) const { return pieces_[at]; }
  const Chain& chain(size_t at) const { return pieces_[at].chain; }
  const Needle* needle(size_t suture) const { return needles_ ? needles_->find(suture) : nullptr; }
  size_t needleHolder(size_t suture) const { return needles_ ? needles_->holderOf(suture) : layout::kMaxStyluses; }
  std::vector<NeedleState> needleStates() const;  ///< needles of the sutures that have one
  const std::vector<ChainSlide>& slides(size_t at) const { return pieces_[at].around.slides; }
  const SutureLinks& links() const { return links_; }
  const std::string& refused() const { return refused_; }  ///< why the last of SutureConfig::ties was not tied

 private:
  /// The substeps of a tick.
  struct Steps {
    int count = 1;
    std::vector<layout::ObstacleMotion> obstacle_motions;  ///< [count * kMaxObstacles]
  };
  void plan(Steps& steps, int count, const ObstacleMotions& obstacles) const;
  void substep(uint32_t suture, const Steps& steps, int index);
  void recordLinks(const Chain& chain);
  const layout::ObstacleMotion* obstaclesOf(const Steps& steps, int index) const;
  bool anyTied() const;
  std::vector<const TissuePoint*> tiedPoints() const;
  void moveNeedles(TissuePort& port, int index);
  void stepLoose();
  void tieWhatIsDue();
  void partWhatBladesMet();
  /// Cuts a piece at a node. @returns whether it was cut
  bool part(uint32_t piece, size_t node);

  const Model* model_;
  std::vector<std::string> names_;  ///< [sutures of the scene]
  std::vector<ObstacleConfig> obstacles_;
  double tick_s_;
  bool can_cut_;
  std::unique_ptr<TissuePoints> tissue_;  ///< null: no suture is in tissue
  WoundLips lips_;
  SutureGrips grips_;
  std::optional<Needles> needles_;  ///< only where sutures are in tissue
  SutureBlades blades_;
  std::vector<std::vector<SutureTie>> ties_;  ///< [sutures of the scene]
  std::vector<SuturePiece> first_, pieces_;   ///< pieces as in the scene, and now
  Steps alone_, tied_;
  int per_substep_ = 1;  ///< substeps of sutures in tissue per substep of the tissue
  double work_j_ = 0;
  uint64_t tick_ = 0;  ///< current tick, since the start or the last reset
  std::string refused_;
  SutureLinks links_;
};

}  // namespace viscera
