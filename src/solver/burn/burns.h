// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "math/archive.h"
#include "solver/burn/burnt_springs.h"
#include "solver/burn/heat_field.h"
#include "solver/thread/tissue_points.h"
#include "viscera/model/model.h"
#include "viscera/tools/stylus.h"

namespace viscera {

struct Scene;

/// What hot tips do to tissue (docs/lessons/cautery.md): heat where they touch it; coagulated tissue shrinks and
/// stiffens, by impulses after each substep; what boils dry parts. Only where a stylus has mode cautery.
class Burns {
 public:
  /// @param model  must outlive them
  Burns(const Scene& scene, const Model& model);

  void setCuts(const CutSprings& cuts);
  void beginTick(const ToolMotions& motions) { motions_ = motions; }
  /// After a substep of the tissue. @returns whether springs were cut
  bool act(BladeTarget& target, int index, double dt_s);

  const HeatField& heat() const { return heat_; }
  SeenBurns seen() const;
  /// Null before the first burn.
  std::shared_ptr<const BurnPaint> paint() const { return paint_; }

  void reset();
  void persist(Archive& archive);
  uint64_t hashWith(uint64_t tissue) const;

 private:
  std::vector<TissuePoint> touchedBy(BladeTarget& target, const StylusMotion& motion, double radius_m) const;
  void heatWhatTipsTouch(BladeTarget& target);
  bool partWhatBoiled(BladeTarget& target);
  double boiledToPart(uint32_t body) const;
  void noteLooks();
  uint32_t bodyOf(uint32_t slot) const;

  const Model& model_;
  const std::vector<StylusConfig> styluses_;
  double tick_s_;
  HeatField heat_;
  TissuePoints tissue_;
  BurntSprings springs_;
  ToolMotions motions_{};
  std::vector<uint32_t> nodes_;     ///< slots of all nodes
  std::vector<uint8_t> is_parted_;  ///< [slots]
  std::vector<uint32_t> parted_;
  CutSprings cuts_;
  uint64_t paints_ = 0;
  std::shared_ptr<const BurnPaint> paint_;
};

}  // namespace viscera
