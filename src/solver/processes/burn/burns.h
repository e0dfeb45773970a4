// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "solver/processes/burn/burnt_springs.h"
#include "solver/processes/burn/heat_field.h"
#include "solver/processes/process.h"
#include "solver/processes/tissue_points.h"
#include "viscera/model/model.h"
#include "viscera/model/scene/stylus_config.h"
#include "viscera/solver/burn_report.h"
#include "viscera/tools/stylus.h"

namespace viscera {

struct Scene;

/// Effects of hot tips on tissue (docs/lessons/instruments.md). Tips heat tissue where they touch it. Coagulated tissue
/// shrinks and stiffens, by impulses after each substep. Tissue that boils dry separates. Exists only if a stylus has
/// mode cautery.
class Burns : public TissueProcess {
 public:
  /// @param model  must outlive them
  Burns(const Scene& scene, const Model& model);

  RollBack rollBack() const override { return RollBack::kKeep; }
  bool readsCuts() const override { return true; }
  void cutsChanged(const CutSprings& cuts) override;
  void beginTick(const ProcessTick&) override { work_j_ = 0; }
  bool act(TissuePort& port, const ProcessTick& tick, const ProcessSubstep& substep) override;
  double work_j() const override { return work_j_; }
  void reset() override;
  void persist(Archive& archive) override;
  bool addTo(StateHash& hash) const override;
  FactGroup facts() const override;
  void draw(ProcessVisuals& visuals) const override;

  const HeatField& heat() const { return heat_; }
  BurnReport seen() const;

 private:
  std::vector<TissuePoint> touchedBy(TissuePort& port, const StylusMotion& motion, double radius_m) const;
  void heatWhatTipsTouch(TissuePort& port, const ToolMotions& motions);
  bool partWhatBoiled(TissuePort& port);
  double boiledToPart(uint32_t body) const;
  void updateVisuals();
  uint32_t bodyOf(uint32_t slot) const;

  const Model& model_;
  const std::vector<StylusConfig> styluses_;
  double tick_s_;
  HeatField heat_;
  TissuePoints tissue_;
  BurntSprings springs_;
  std::vector<uint32_t> nodes_;     ///< slots of all nodes
  std::vector<uint8_t> is_parted_;  ///< [slots]
  std::vector<uint32_t> parted_;
  CutSprings cuts_;
  double work_j_ = 0;                       ///< work of shrinking tissue on the rest in the tick
  std::shared_ptr<const NodePaint> paint_;  ///< null before the first burn
};

}  // namespace viscera
