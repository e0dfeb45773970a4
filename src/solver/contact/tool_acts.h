// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "solver/contact/tool_target.h"
#include "viscera/model/scene/stylus_config.h"
#include "viscera/tools/stylus.h"

namespace viscera {

/// What tools do in a tick of any backend and of the reference: a list of acts (tool_acts.cpp), each of which belongs
/// to some ToolEffect and is run for the styluses whose kind has it. What tools do to each node within a substep is the
/// kernels' (shaders/solver/tools/contact.glsl), by the same effects.
class ToolActs {
 public:
  /// @param tick_s  length of a tick   @param resisted  blades cut by fracture work (Blades), not here
  ToolActs(std::vector<StylusConfig> styluses, double tick_s, bool resisted = false);

  bool touch(const ToolMotions& motions) const;  ///< does a stylus move nodes in this tick?
  bool sever(const ToolMotions& motions) const;  ///< does one cut?
  void beginTick(ToolTarget& target, const ToolMotions& motions) const;
  void beforeSubstep(ToolTarget& target, const ToolMotions& motions) const;
  /// After the last substep, when the momentum that each stylus gave in the tick is known.
  void endTick(ToolTarget& target, const ToolMotions& motions) const;

  const std::vector<StylusConfig>& styluses() const { return styluses_; }

 private:
  std::vector<StylusConfig> styluses_;
  double tick_s_;
  bool resisted_;
};

}  // namespace viscera
