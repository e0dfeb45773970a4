// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "solver/ticks/rollback_guard.h"

#include <algorithm>
#include <cmath>

#include "math/archive.h"
#include "tools/motion_packing.h"
#include "tools/restored_tools.h"

namespace viscera {

namespace {

/// Returns the work of tools on the tissue [J]: the mean force of each tool over the tick, times its displacement, and
/// for shafts that tissue meets the mean moment times the rotation. Exact if all nodes that a tool moves share its
/// motion at one speed.
double workOfTools(const layout::TickStats& stats, const ToolMotions& motions, double tick_s) {
  double work = 0;
  for (size_t s = 0; s < motions.size(); ++s) {
    const Vector3d impulse(stats.impulse[s].x, stats.impulse[s].y, stats.impulse[s].z);
    const Vector3d angular(stats.angular[s].x, stats.angular[s].y, stats.angular[s].z);
    double part = impulse.dot(motions[s].to.position_m - motions[s].from.position_m) / tick_s;
    if (motions[s].shaft_to_m >= 0) part += angular.dot(turnOfShaft(motions[s])) / tick_s;
    if (std::isfinite(part)) work += std::max(0.0, part);
  }
  return work;
}

}  // namespace

RollbackGuard::RollbackGuard(SolverBackend& backend, const StabilityMonitor& stability_monitor, bool may_be_fast,
                             double tick_s, ProcessList& processes)
    : backend_(backend),
      stability_monitor_(stability_monitor),
      may_be_fast_(may_be_fast),
      tick_s_(tick_s),
      processes_(processes) {
  processes_.saveGood();  // the backend has done so
}

void RollbackGuard::guard(const ToolMotions& motions, bool recovering) {
  if (backend_.lag() == 0) return;
  StabilityMonitor::Bounds bounds = stability_monitor_.bounds(mayBeFast(recovering));
  bounds.energy_j += StabilityMonitor::kEnergyMargin * processes_.work_j();
  backend_.guard(bounds, motions, tick_s_);
}

RollbackGuard::Verdict RollbackGuard::endTick(const ToolMotions& motions, bool recovering, bool undone,
                                              bool long_substeps) {
  OpenTick tick;
  tick.motions = motions;
  tick.recovering = recovering;
  tick.undone = undone;
  tick.long_substeps = long_substeps;
  tick.pulls = processes_.pulls();
  tick.processes_j = processes_.work_j();
  open_ = tick;
  Verdict verdict;
  if (!undone && backend_.lag() == 0) verdict = judgeOpen();
  if (!undone && !verdict.rolled_back) saveGood();
  return verdict;
}

void RollbackGuard::saveGood() {
  backend_.saveGood();
  processes_.saveGood();
}

double RollbackGuard::workOn(const OpenTick& tick) const {
  return workOfTools(*tick.stats, tick.motions, tick_s_) + tick.processes_j;
}

/// Returns whether the open tick's measurements have arrived.
bool RollbackGuard::receive(bool wait) {
  if (open_->stats) return true;
  layout::TickStats stats;
  if (!backend_.takeStats(stats, wait)) return false;
  open_->stats = stats;
  return true;
}

/// Returns whether the open tick is bad. Its measurements have arrived.
bool RollbackGuard::isBad() const {
  return open_->undone || stability_monitor_.inspect(*open_->stats, mayBeFast(open_->recovering), workOn(*open_)) !=
                              StabilityMonitor::Trip::kNone;
}

/// Returns the published findings of the open tick: none of a bad tick, and no force during a recovery.
TickFindings RollbackGuard::published() const {
  const bool bad = isBad();
  TickFindings out;
  layout::TickStats& stats = out.stats;
  stats = bad ? last_good_ : *open_->stats;
  stats.springs_cut = open_->stats->springs_cut;
  if (!bad && !open_->recovering) {
    out.pulls = open_->pulls;
    addTo(stats, out.pulls);
    return out;
  }
  for (uint32_t s = 0; s < layout::kMaxStyluses; ++s) stats.impulse[s] = stats.angular[s] = {};
  for (uint32_t o = 0; o < layout::kMaxObstacles; ++o) stats.obstacle_impulse[o] = stats.obstacle_angular[o] = {};
  return out;
}

RollbackGuard::Verdict RollbackGuard::judgeOpen() {
  Verdict verdict;
  if (!open_) return verdict;
  receive(true);
  if (!open_->delivered) verdict.published = published();
  const OpenTick tick = *open_;
  open_.reset();
  if (tick.undone) return verdict;
  const bool fast = mayBeFast(tick.recovering);
  if (stability_monitor_.judge(*tick.stats, fast, workOn(tick), tick.long_substeps) == StabilityMonitor::Trip::kNone) {
    last_good_ = *tick.stats;
    verdict.good = tick.stats;
    return verdict;
  }
  const int back = stability_monitor_.setbacks() - 1 + backend_.lag();
  backend_.restoreGood(back);
  processes_.restoreGood(back);
  verdict.rolled_back = true;
  return verdict;
}

bool RollbackGuard::openIsBad() {
  if (!open_) return false;
  receive(true);
  return isBad();
}

bool RollbackGuard::poll(TickFindings& findings, bool wait) {
  if (!open_ || open_->delivered || !receive(wait)) return false;
  open_->delivered = true;
  findings = published();
  return true;
}

const layout::TickStats& RollbackGuard::restart() {
  backend_.measure();
  backend_.requestStats();
  backend_.takeStats(last_good_, true);
  stability_monitor_.restart(last_good_);
  keepOnlyCurrent();
  return last_good_;
}

void RollbackGuard::reset(const StabilityMonitor& stability_monitor) {
  open_.reset();
  stability_monitor_ = stability_monitor;
  last_good_ = {};
  keepOnlyCurrent();
}

void RollbackGuard::persist(Archive& archive) {
  archive.section("stability_monitor");
  archive.value(stability_monitor_);
  archive.value(last_good_);
  bool open = open_.has_value();
  archive.value(open);
  if (archive.reads()) open_.reset();
  if (!open) return;
  OpenTick tick = open_.value_or(OpenTick{});
  layout::TickStats stats = tick.stats.value_or(layout::TickStats{});
  archive.value(tick.motions);
  requireModes(archive, tick.motions);
  archive.value(tick.recovering);
  archive.value(tick.undone);
  archive.value(tick.long_substeps);
  archive.value(tick.pulls);
  archive.value(tick.processes_j);
  archive.value(stats);
  tick.delivered = true;
  tick.stats = stats;
  if (archive.reads()) open_ = tick;
}

void RollbackGuard::keepOnlyCurrent() {
  backend_.clearGood();
  processes_.clearGood();
  saveGood();
}

}  // namespace viscera
