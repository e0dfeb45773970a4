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

}  // namespace

LatticeSolver::LatticeSolver(const Model& model, const Scene& scene, const SolverOptions& options)
    : model_(model),
      config_(scene.solver),
      acts_(scene.styluses, 1 / scene.solver.tick_hz),
      gravity_(scene.environment.gravity_m_per_s2.cast<float>()),
      tick_s_(1 / scene.solver.tick_hz),
      dt_safe_s_(safeTimeStep(model)),
      push_speed_m_per_s_(pushSpeed(model)),
      plan_(planSubsteps(model, scene.solver, dt_safe_s_, options.allow_unstable)),
      recovery_substeps_(std::max(1, plan_.strained / kRecoveryIterations)) {
  finished_.reserve(kFinishedKept);
  if (surroundingsOf(model, scene).any()) surroundings_.emplace(model, scene);
  SolverBackend& backend = *this;
  if (config_.governor) watch_.emplace(backend, newGovernor(), !traitsOf(config_.integrator).is_explicit, tick_s_);
  if (hasTools()) motions_.reserve(static_cast<size_t>(mostSubsteps()) * layout::kMaxStyluses);
}

Governor LatticeSolver::newGovernor() const {
  return Governor(governorLimits(model_, gravity_.norm(), config_.sleep_distance_m), tick_s_, config_.recovery_s);
}

int LatticeSolver::mostSubsteps() const {
  return watch_ ? std::max(plan_.strained, recovery_substeps_) : plan_.strained;
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
  const bool undone = watch_ && heed(watch_->judgeOpen());  // of the tick before, where the backend lags
  measureTick(motions, contacts);
  finishStats();
  if (watch_) heed(watch_->endTick(motions, recovering_, undone));
}

void LatticeSolver::measureTick(const ToolMotions& motions, bool contacts) {
  measure();
  if (contacts) {
    sumReactions({motions[0].to.position_m.cast<float>(), motions[1].to.position_m.cast<float>()});
    acts_.endTick(*this, motions);
  }
  if (watch_) watch_->guard(motions, recovering_);
}

void LatticeSolver::chooseSubsteps() {
  const bool recover = watch_ && watch_->health().recovering;
  const bool strained = watch_ && watch_->health().strained;
  restarted_ |= recover != recovering_;
  recovering_ = recover;
  n_ = recover ? recovery_substeps_ : strained ? plan_.strained : plan_.calm;
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
  resetState();
  restarted_ = true;
  springs_cut_ = 0;
  dt_safe_s_ = safeTimeStep(model_);
  plan_ = planSubsteps(model_, config_, dt_safe_s_, true);
  if (watch_) watch_->reset(newGovernor());
  ++cut_revision_;
}

void LatticeSolver::writeState(const HostState& state, bool staggered) {
  if (watch_) heed(watch_->judgeOpen());
  loadState(state);
  restarted_ = !staggered || traitsOf(config_.integrator).own_positions;
  if (staggered && last_dt_s_ == 0) last_dt_s_ = dt_s();
  if (staggered) recovering_ = false;
  ++cut_revision_;
  if (watch_) watch_->restart();
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

/// Does what follows from a verdict. @returns whether there was a rollback
bool LatticeSolver::heed(const Watch::Verdict& verdict) {
  if (verdict.published) keepStats(*verdict.published);
  if (verdict.good) relaxSubsteps(*verdict.good);
  restarted_ |= verdict.rolled_back;
  return verdict.rolled_back;
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
  if (watch_ && watch_->openIsBad()) return 0;  // the state was put back already
  const bool lags = traitsOf(config_.integrator).staggered && !recovering_ && !restarted_;
  return lags ? 0.5 * last_dt_s_ : 0;
}

const Health& LatticeSolver::health() const {
  static const Health kUnwatched;
  return watch_ ? watch_->health() : kUnwatched;
}

bool LatticeSolver::pollStats(layout::TickStats& stats, bool wait) {
  if (!finished_.empty()) {
    stats = finished_.front();
    finished_.erase(finished_.begin());
    return true;
  }
  return watch_ ? watch_->poll(stats, wait) : takeStats(stats, wait);
}

}  // namespace viscera
