// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "solver/lattice_solver.h"

#include <algorithm>
#include <cmath>

#include "math/float_bits.h"
#include "tools/motion_packing.h"

namespace viscera {

namespace {

constexpr size_t kFinishedKept = 3;   // ticks whose measurements wait for somebody who asks
constexpr double kWorthwhile = 1.01;  // a stable substep must have grown by this factor to be taken

/// Work on the tissue [J]: the force of each tool, mean over the tick, along its way. Exact where all nodes that it
/// moves go its way at one speed.
double workOfTools(const layout::TickStats& stats, const ToolMotions& motions, double tick_s) {
  double work = 0;
  for (size_t s = 0; s < motions.size(); ++s) {
    const Vector3d impulse(stats.impulse[s].x, stats.impulse[s].y, stats.impulse[s].z);
    const double part = impulse.dot(motions[s].to.position_m - motions[s].from.position_m) / tick_s;
    if (std::isfinite(part)) work += std::max(0.0, part);
  }
  return work;
}

}  // namespace

LatticeSolver::LatticeSolver(const Model& model, const Scene& scene, const SolverOptions& options)
    : model_(model),
      config_(scene.solver),
      acts_(scene.styluses, 1 / scene.solver.tick_hz),
      gravity_(scene.environment.gravity_m_per_s2.cast<float>()),
      tick_s_(1 / scene.solver.tick_hz),
      dt_safe_s_(safeTimeStep(model)),
      push_speed_m_per_s_(pushSpeed(model)),
      plan_(planSubsteps(model, scene.solver, dt_safe_s_, options.allow_unstable)) {
  finished_.reserve(kFinishedKept);
  if (surroundingsOf(model, scene).any()) surroundings_.emplace(model, scene);
  if (config_.governor) watch_.emplace(Watch{newGovernor(), std::max(1, plan_.strained / kRecoveryIterations), {}, {}});
  if (hasTools()) motions_.reserve(static_cast<size_t>(mostSubsteps()) * layout::kMaxStyluses);
}

Governor LatticeSolver::newGovernor() const {
  return Governor(governorLimits(model_, gravity_.norm(), config_.sleep_distance_m), tick_s_, config_.recovery_s);
}

int LatticeSolver::mostSubsteps() const {
  return watch_ ? std::max(plan_.strained, watch_->recovery_substeps) : plan_.strained;
}

void LatticeSolver::step(const ToolMotions& motions, const ObstacleMotions& obstacles) {
  const bool contacts = acts_.touch(motions), cuts = acts_.sever(motions);
  chooseSubsteps();
  beginTick();
  acts_.beginTick(*this, motions);
  if (surroundings_) {
    surroundings_->beginTick(tick_s_, n_, obstacles);
    beginSurroundings(*surroundings_);
  }
  if (contacts || cuts) {
    interpolateMotions(motions, acts_.styluses(), n_, motions_);
    for (layout::ToolMotion& motion : motions_) motion.timing.x = static_cast<float>(tick_s_ / n_);
    for (size_t s = 0; s < layout::kMaxStyluses; ++s)
      motions_[s].timing.x = static_cast<float>(restarted_ ? 0 : last_dt_s_);
    writeMotions(motions_);
  }
  for (int s = 0; s < n_; ++s) {
    if (contacts || cuts) selectMotions(static_cast<size_t>(s));
    substep(s, motions, cuts, contacts);
  }
  substeps_done_ += static_cast<uint64_t>(n_);
  if (cuts) ++cut_revision_;
  const bool undone = watch_ && judgeOpen();  // of the tick before, where the backend lags
  measureTick(motions, contacts);
  finishStats();
  if (watch_) govern(motions, undone);
}

void LatticeSolver::measureTick(const ToolMotions& motions, bool contacts) {
  measure();
  if (contacts) {
    sumReactions({motions[0].to.position_m.cast<float>(), motions[1].to.position_m.cast<float>()});
    acts_.endTick(*this, motions);
  }
  if (watch_ && lag() > 0) guard(watch_->governor.bounds(isImplicit(recovering_)), motions, tick_s_);
}

void LatticeSolver::chooseSubsteps() {
  const bool recover = watch_ && watch_->governor.health().recovering;
  const bool strained = watch_ && watch_->governor.health().strained;
  restarted_ |= recover != recovering_;
  recovering_ = recover;
  n_ = recover ? watch_->recovery_substeps : strained ? plan_.strained : plan_.calm;
}

void LatticeSolver::substep(int index, const ToolMotions& motions, bool cuts, bool contacts) {
  if (cuts) acts_.beforeSubstep(*this, motions);
  const double dt_s = tick_s_ / n_;
  Substep step;
  step.dt_s = static_cast<float>(dt_s);
  step.kick_s = static_cast<float>(restarted_ ? 0.5 * dt_s : 0.5 * (last_dt_s_ + dt_s));
  step.gravity = gravity_;
  step.sleep_distance_m = static_cast<float>(config_.sleep_distance_m);
  step.push_speed_m_per_s = static_cast<float>(push_speed_m_per_s_);
  step.tools = contacts;
  step.restarted = restarted_;
  step.index = index;
  advance(step, recovering_);
  if (surroundings_) surround(step, *surroundings_);
  restarted_ = false;
  last_dt_s_ = dt_s;
}

void LatticeSolver::reset() {
  if (surroundings_) surroundings_->reset();
  layout::TickStats old;
  while (takeStats(old, true)) {
  }
  finished_.clear();
  if (watch_) watch_->open.reset();
  resetState();
  restarted_ = true;
  springs_cut_ = 0;
  dt_safe_s_ = safeTimeStep(model_);
  plan_ = planSubsteps(model_, config_, dt_safe_s_, true);
  if (watch_) {
    watch_->governor = newGovernor();
    clearGood();
    saveGood();
  }
  ++cut_revision_;
}

void LatticeSolver::writeState(const HostState& state, bool staggered) {
  if (watch_) judgeOpen();
  loadState(state);
  restarted_ = !staggered || traitsOf(config_.integrator).own_positions;
  if (staggered && last_dt_s_ == 0) last_dt_s_ = dt_s();
  if (staggered) recovering_ = false;
  ++cut_revision_;
  if (!watch_) return;
  measure();
  requestStats();
  takeStats(watch_->last_good, true);
  watch_->governor.restart(watch_->last_good);
  clearGood();
  saveGood();
}

/// Sends a tick's measurements on their way. Where the backend is as many ticks behind as it may be, waiting here is
/// what keeps the two together.
void LatticeSolver::finishStats() {
  if (requestStats()) return;
  layout::TickStats oldest;
  takeStats(oldest, true);
  keepStats(oldest);
  requestStats();
}

/// Of more than kFinishedKept that nobody has asked for, the oldest is forgotten.
void LatticeSolver::keepStats(const layout::TickStats& stats) {
  if (finished_.size() == kFinishedKept) finished_.erase(finished_.begin());
  finished_.push_back(stats);
}

/// Ends a tick: keeps its state if it is good or may be. @param undone  the tick before was not, and was rolled back
void LatticeSolver::govern(const ToolMotions& motions, bool undone) {
  OpenTick tick;
  tick.motions = motions;
  tick.recovering = recovering_;
  tick.undone = undone;
  watch_->open = tick;
  const bool bad = undone || (lag() == 0 && judgeOpen());
  if (!bad) saveGood();
}

/// Have the open tick's measurements come?
bool LatticeSolver::receiveOpen(bool wait) {
  if (watch_->open->stats) return true;
  layout::TickStats stats;
  if (!takeStats(stats, wait)) return false;
  watch_->open->stats = stats;
  return true;
}

bool LatticeSolver::openIsBad() const {
  const OpenTick& tick = *watch_->open;
  const double work_j = workOfTools(*tick.stats, tick.motions, tick_s_);
  return tick.undone ||
         watch_->governor.inspect(*tick.stats, isImplicit(tick.recovering), work_j) != Governor::Trip::kNone;
}

/// What others are told of the open tick: nothing that is bad, and no force while the tissue is not itself.
layout::TickStats LatticeSolver::publishedOfOpen() const {
  const OpenTick& tick = *watch_->open;
  const bool bad = openIsBad();
  layout::TickStats out = bad ? watch_->last_good : *tick.stats;
  out.springs_cut = tick.stats->springs_cut;
  if (!bad && !tick.recovering) return out;
  for (uint32_t s = 0; s < layout::kMaxStyluses; ++s) out.impulse[s] = out.angular[s] = {};
  return out;
}

/// Judges the tick that is open, if one is, and closes it; rolls it back where it was bad. Waits for its measurements.
/// @returns whether there was a rollback
bool LatticeSolver::judgeOpen() {
  if (!watch_->open) return false;
  receiveOpen(true);
  if (!watch_->open->delivered) keepStats(publishedOfOpen());
  const OpenTick tick = *watch_->open;
  watch_->open.reset();
  if (tick.undone) return false;
  Governor& governor = watch_->governor;
  const double work_j = workOfTools(*tick.stats, tick.motions, tick_s_);
  if (governor.judge(*tick.stats, isImplicit(tick.recovering), work_j) == Governor::Trip::kNone) {
    watch_->last_good = *tick.stats;
    relaxSubsteps(*tick.stats);
    return false;
  }
  restoreGood(governor.setbacks() - 1 + lag());
  restarted_ = true;
  return true;
}

/// A cut takes springs and no mass, so the stable substep can only grow.
void LatticeSolver::relaxSubsteps(const layout::TickStats& stats) {
  if (stats.springs_cut == springs_cut_) return;
  springs_cut_ = stats.springs_cut;
  const float rate = floatFromBits(stats.max_rate_bits);
  if (rate <= 0) return;
  const double dt_safe_s = 2 / std::sqrt(static_cast<double>(rate));
  if (dt_safe_s < kWorthwhile * dt_safe_s_) return;
  dt_safe_s_ = dt_safe_s;
  plan_ = planSubsteps(model_, config_, dt_safe_s_, true);
}

double LatticeSolver::velocityLag_s() {
  if (watch_ && watch_->open) {
    receiveOpen(true);
    if (openIsBad()) return 0;  // the state was put back already
  }
  const bool lags = traitsOf(config_.integrator).staggered && !recovering_ && !restarted_;
  return lags ? 0.5 * last_dt_s_ : 0;
}

const Health& LatticeSolver::health() const {
  static const Health kUnwatched;
  return watch_ ? watch_->governor.health() : kUnwatched;
}

bool LatticeSolver::pollStats(layout::TickStats& stats, bool wait) {
  if (!finished_.empty()) {
    stats = finished_.front();
    finished_.erase(finished_.begin());
    return true;
  }
  if (!watch_) return takeStats(stats, wait);
  if (!watch_->open || watch_->open->delivered || !receiveOpen(wait)) return false;
  watch_->open->delivered = true;
  stats = publishedOfOpen();
  return true;
}

}  // namespace viscera
