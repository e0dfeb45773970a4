// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "solver/contact/tool_acts.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "model/scene/tool_kinds.h"
#include "tools/motion_packing.h"

namespace viscera {

namespace {

/// One stylus in one tick.
struct Tool {
  ToolPort& target;
  uint32_t stylus;
  const StylusMotion& motion;
  const StylusConfig& config;
  double tick_s;
  bool resisted;
};

/// Actions of an effect at the moments of a tick; null where there is none.
struct ToolAct {
  uint32_t effects;
  void (*begin_tick)(const Tool&);
  void (*before_substep)(const Tool&);
  void (*end_tick)(const Tool&);
};

/// Ends the previous hold before a new one begins, possibly of another kind.
void changeGrip(const Tool& tool) {
  const ToolKind& before = kindOf(tool.motion.hold_ended);
  if (before.grip) tool.target.letGo(tool.stylus, {before.grip(tool.config).release_speed_m_per_s});
  if (!tool.motion.hold_begins) return;
  tool.target.takeHold(tool.stylus, tool.motion.from, kindOf(tool.motion.mode).reach_m(tool.config));
}

/// Releases nodes above the force limit. Nothing is held again until a new hold begins.
void letGoAboveLimit(const Tool& tool) {
  const ToolKind& kind = kindOf(tool.motion.mode);
  if (!kind.grip || kind.grips) return;
  const Grip grip = kind.grip(tool.config);
  if (!std::isfinite(grip.max_force_n)) return;
  tool.target.letGo(tool.stylus, {grip.release_speed_m_per_s, grip.max_force_n * tool.tick_s});
}

void cut(const Tool& tool) {
  const bool erases = kindOf(tool.motion.mode).does(kErases);
  if (erases || !tool.resisted) tool.target.cut(tool.stylus, erases);
}

constexpr ToolAct kToolActs[] = {
    {kHolds, changeGrip, nullptr, letGoAboveLimit},
    {kCuts | kErases, nullptr, cut, nullptr},
};

/// Runs one moment of all acts, for each stylus of a kind that has the effect in this tick.
void run(void (*ToolAct::*moment)(const Tool&), ToolPort& target, const ToolMotions& motions,
         const std::vector<StylusConfig>& styluses, double tick_s, bool resisted) {
  for (const ToolAct& act : kToolActs) {
    if (!(act.*moment)) continue;
    for (uint32_t s = 0; s < styluses.size(); ++s) {
      const uint32_t effects = effectsOf(motions[s]) | kindOf(motions[s].hold_ended).effects;
      if (effects & act.effects) (act.*moment)({target, s, motions[s], styluses[s], tick_s, resisted});
    }
  }
}

}  // namespace

ToolActs::ToolActs(std::vector<StylusConfig> styluses, double tick_s, bool resisted)
    : styluses_(std::move(styluses)), tick_s_(tick_s), resisted_(resisted) {}

bool ToolActs::touch(const ToolMotions& motions) const {
  return std::any_of(
      motions.begin(), motions.begin() + static_cast<std::ptrdiff_t>(styluses_.size()),
      [](const StylusMotion& motion) { return kindOf(motion.mode).touches() || motion.shaft_to_m >= 0; });
}

bool ToolActs::sever(const ToolMotions& motions) const {
  return std::any_of(motions.begin(), motions.begin() + static_cast<std::ptrdiff_t>(styluses_.size()),
                     [](const StylusMotion& motion) { return effectsOf(motion) & (kCuts | kErases); });
}

void ToolActs::beginTick(ToolPort& target, const ToolMotions& motions) const {
  run(&ToolAct::begin_tick, target, motions, styluses_, tick_s_, resisted_);
}

void ToolActs::beforeSubstep(ToolPort& target, const ToolMotions& motions) const {
  run(&ToolAct::before_substep, target, motions, styluses_, tick_s_, resisted_);
}

void ToolActs::endTick(ToolPort& target, const ToolMotions& motions) const {
  run(&ToolAct::end_tick, target, motions, styluses_, tick_s_, resisted_);
}

}  // namespace viscera
