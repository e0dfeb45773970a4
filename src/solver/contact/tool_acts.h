// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "solver/contact/tool_port.h"
#include "viscera/model/scene/stylus_config.h"
#include "viscera/tools/stylus.h"

namespace viscera {

/// Actions of tools in a tick, on any backend and in the reference: a list of acts (tool_acts.cpp). Each belongs to
/// some ToolEffect and runs for the styluses of a kind with that effect. The effects on single nodes within a substep
/// are computed by kernels (shaders/solver/tools/contact.glsl), by the same ToolEffects.
class ToolActs {
 public:
  /// @param tick_s  length of a tick [s]   @param resisted  blades cut by fracture work (Blades), not here
  ToolActs(std::vector<StylusConfig> styluses, double tick_s, bool resisted = false);

  bool touch(const ToolMotions& motions) const;  ///< whether a stylus moves nodes in this tick
  bool sever(const ToolMotions& motions) const;  ///< whether a stylus cuts
  void beginTick(ToolPort& target, const ToolMotions& motions) const;
  void beforeSubstep(ToolPort& target, const ToolMotions& motions) const;
  /// Acts after the last substep, when the momentum that each stylus gave in the tick is known.
  void endTick(ToolPort& target, const ToolMotions& motions) const;

  const std::vector<StylusConfig>& styluses() const { return styluses_; }

 private:
  std::vector<StylusConfig> styluses_;
  double tick_s_;
  bool resisted_;
};

}  // namespace viscera
