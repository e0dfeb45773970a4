// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "solver/processes/bleed/blood_film.h"
#include "solver/processes/bleed/vessels.h"
#include "solver/processes/burn/heat_field.h"
#include "solver/processes/clip/clips.h"
#include "solver/processes/process.h"
#include "viscera/model/model.h"
#include "viscera/model/scene/stylus_config.h"
#include "viscera/solver/blood_report.h"

namespace viscera {

class Pressures;

/// Blood, or bile, that flows out of cut vessels, down the tissue and off it, until clips or burns stop it
/// (docs/lessons/instruments.md). It exerts no forces. A scene has one of these for each fluid of its parts.
class Bleeding : public TissueProcess {
 public:
  /// @param model  must outlive it   @param gravity_m_per_s2  tissue frame   @param tick_s  length of a tick [s]
  Bleeding(const Model& model, const std::vector<StylusConfig>& styluses, const Vector3d& gravity_m_per_s2,
           double tick_s, Fluid fluid);

  RollBack rollBack() const override { return RollBack::kKeep; }
  bool readsCuts() const override { return true; }
  void cutsChanged(const CutSprings& cuts) override;
  /// Lets fluid flow out of vessels that are cut and neither clipped nor burnt, down the tissue, and into suction.
  bool endTick(TissuePort& port, const ProcessTick& tick, const TissueProcesses& all) override;
  void reset() override;
  void persist(Archive& archive) override;
  bool addTo(StateHash& hash) const override;
  FactGroup facts() const override;
  void draw(ProcessVisuals& visuals) const override;

  Fluid fluid() const { return fluid_; }
  BloodReport seen() const;

 private:
  double fullness(const Vessels::Leak& leak) const;
  void leak();
  void suck(const TissuePort& port, const ToolMotions& motions);
  void detectClosed(const Clips* clips, const HeatField* heat);
  void findLeaks(const Pressures* pressures);
  void updateVisuals();

  const Model& model_;
  const std::vector<StylusConfig> styluses_;
  const double tick_s_;
  const Fluid fluid_;
  const HeatGraph graph_;
  Vessels vessels_;
  BloodFilm film_;
  std::vector<uint8_t> is_cut_;     ///< [links]
  std::vector<uint8_t> is_closed_;  ///< [slots]
  std::vector<std::array<Vector3d, 2>> squeezed_m_;
  size_t coagulated_ = 0;
  bool is_stale_ = true;  ///< something was cut or closed since the last search for leaks
  Vessels::Leaks found_;  ///< by that search
  Vessels::Leaks leaks_;  ///< with those of bodies under pressure
  double bled_m3_ = 0, suctioned_m3_ = 0;
  std::vector<double> left_m3_;             ///< [groups] of Vessels::supplies_m3()
  std::shared_ptr<const NodePaint> paint_;  ///< null before any fluid
};

}  // namespace viscera
