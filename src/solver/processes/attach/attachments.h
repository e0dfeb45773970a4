// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "solver/processes/attach/fibre_forces.h"
#include "solver/processes/attach/fibres.h"
#include "solver/processes/process.h"
#include "solver/processes/suture/suture_blades.h"
#include "viscera/model/model.h"
#include "viscera/model/scene/attachment_config.h"
#include "viscera/solver/fibre_state.h"

namespace viscera {

struct Scene;
class Burns;

/// Connective tissue between bodies (docs/physics.md 17): fibres that pull after each substep, tear as they open, and
/// are cut by blades and weakened by burns.
class Attachments : public TissueProcess {
 public:
  /// @param model  must outlive them   @throws SceneError  as growFibres()
  Attachments(const Scene& scene, const Model& model);

  RollBack rollBack() const override { return RollBack::kUndo; }
  bool readsCuts() const override { return true; }
  void cutsChanged(const CutSprings& cuts) override;
  void beginTick(const ProcessTick& tick) override;
  bool act(TissuePort& port, const ProcessTick& tick, const ProcessSubstep& substep) override;
  bool endTick(TissuePort& port, const ProcessTick& tick, const TissueProcesses& all) override;
  double work_j() const override { return work_j_; }
  void reset() override;
  void persist(Archive& archive) override;
  void persistUndone(Archive& archive) override;
  void undone(bool at_rest) override;
  bool addTo(StateHash& hash) const override;
  FactGroup facts() const override;
  /// Adds strands, where fibres are open by more than half of their thickness.
  void draw(ProcessVisuals& visuals) const override;
  std::vector<FibreState> seen() const;

 private:
  void orderStrands();
  void updateSecant(size_t fibre);
  void updateSecants();
  bool isWhole(size_t fibre) const;
  void part(size_t fibre, std::vector<double>& to);
  void grow(size_t fibre, const Vector3d& gap_m);
  void weaken(const Burns& burns);
  Vector3d normalAt(size_t fibre) const;
  std::vector<Vector3d> spanOf(size_t fibre) const;

  std::vector<AttachmentConfig> configs_;
  FibreCells cells_;
  std::vector<Fibre> grown_;   ///< fibres as they were grown
  std::vector<Fibre> fibres_;  ///< the same with their ends in whole cells
  FibreForces forces_;
  SutureBlades blades_;
  std::vector<uint32_t> strand_order_;  ///< fibres that may be drawn, those first that are if too many are open
  bool may_be_cut_ = false;             ///< a blade moves in this tick
  std::vector<layout::NodeBits> seen_;  ///< [slots] springs of the nodes when ends were embedded; empty: whole
  // State.
  std::vector<float> opening_m_;           ///< [fibres] largest so far
  std::vector<float> left_;                ///< [fibres] share of strength and toughness that burns have left; 0: cut
  std::vector<double> spent_j_;            ///< [attachments] work lost in fibres that opened
  std::vector<double> cut_m2_, burnt_m2_;  ///< [attachments] areas that blades cut, and that burns destroyed
  double work_j_ = 0;
};

}  // namespace viscera
