// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "viscera/tools/stylus.h"

namespace viscera {

/// How nodes are let go.
struct Release {
  double speed_m_per_s;   ///< faster nodes are slowed to this
  double above_n_s = -1;  ///< only if the stylus gave more momentum than this in the tick; below 0: in any case
};

/// What tools ask of what holds the tissue: a backend, or the reference. It is asked in the order of a tick, and may
/// do it later, as long as that order stays.
class ToolTarget {
 public:
  virtual ~ToolTarget() = default;
  /// @param stylus  index, < kMaxStyluses   @param pose  of the stylus, tissue frame   @param radius_m  of the grip
  virtual void takeHold(uint32_t stylus, const Pose& pose, double radius_m) = 0;
  virtual void letGo(uint32_t stylus, const Release& release) = 0;
  /// Cuts with the blade's motion in the substep that comes. @param particles  erase nodes instead of single springs
  virtual void cut(uint32_t stylus, bool particles) = 0;
};

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
