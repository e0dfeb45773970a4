// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <vector>

#include "solver/processes/blade/blade_edge.h"
#include "solver/processes/blade/blade_point.h"
#include "solver/processes/process.h"

namespace viscera {

struct StylusConfig;

/// The edges and points of all styluses in all bodies that resist blades, with what they have cut (docs/cutting.md).
class Blades : public TissueProcess {
 public:
  /// @param model  must outlive them
  Blades(const Model& model, const std::vector<StylusConfig>& styluses);

  RollBack rollBack() const override { return RollBack::kRestart; }
  bool act(TissuePort& port, const ProcessTick& tick, const ProcessSubstep& substep) override;
  bool endTick(TissuePort& port, const ProcessTick& tick, const TissueProcesses& all) override;
  bool pushesStyluses(const ProcessTick& tick) const override { return tick.cuts; }
  bool restart(TissuePort& port) override;
  void reset() override;
  void persist(Archive& archive) override;
  FactGroup facts() const override;
  BladeWork done(uint32_t stylus) const;

 private:
  struct Cut {
    Cut(const Model& model, size_t body, const std::vector<StylusConfig>& styluses);
    size_t body;
    std::unique_ptr<RestTissue> tissue;
    std::vector<BladeEdge> edges;                   ///< [kMaxStyluses]
    std::vector<std::optional<BladePoint>> points;  ///< points [kMaxStyluses] of blades that cut with them too
  };
  std::vector<Cut> cuts_;  ///< one per body that resists blades
  size_t styluses_;
};

/// Returns the work of a stylus's blade on tissue that resists it; zeros if none does. @param stylus  < kMaxStyluses
BladeWork bladeWork(const Solver& solver, uint32_t stylus);

}  // namespace viscera
