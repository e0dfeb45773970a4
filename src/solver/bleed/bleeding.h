// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "math/archive.h"
#include "solver/bleed/blood_film.h"
#include "solver/bleed/vessels.h"
#include "solver/burn/heat_field.h"
#include "solver/thread/clips.h"
#include "viscera/model/model.h"
#include "viscera/solver/seen_blood.h"

namespace viscera {

/// Blood that runs out of cut vessels, down the tissue and off it, until clips or burns stop it
/// (docs/lessons/bleeding.md). It pushes nothing. Only where some part bleeds.
class Bleeding {
 public:
  /// @param model  must outlive it   @param gravity_m_per_s2  tissue frame
  Bleeding(const Model& model, const Vector3d& gravity_m_per_s2);

  void setCuts(const CutSprings& cuts);
  /// At the end of a tick. @param clips, heat  null: the scene has none
  void step(const Clips* clips, const HeatField* heat, double tick_s);

  SeenBlood seen() const;
  /// Null before any blood.
  std::shared_ptr<const BloodPaint> paint() const { return paint_; }

  void reset();
  void persist(Archive& archive);
  uint64_t hashWith(uint64_t tissue) const;  ///< that of the tissue where there is no blood

 private:
  void lookWhatCloses(const Clips* clips, const HeatField* heat);
  void noteLooks();

  const Model& model_;
  const HeatGraph graph_;
  Vessels vessels_;
  BloodFilm film_;
  std::vector<uint8_t> is_cut_;     ///< [links]
  std::vector<uint8_t> is_closed_;  ///< [slots]
  std::vector<std::array<Vector3d, 2>> squeezed_m_;
  size_t coagulated_ = 0;
  bool is_stale_ = true;  ///< something was cut or closed since leaks were looked for
  Vessels::Leaks leaks_;
  double bled_m3_ = 0;
  uint64_t paints_ = 0;
  std::shared_ptr<const BloodPaint> paint_;
};

}  // namespace viscera
