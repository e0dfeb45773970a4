// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "solver/ticks/tissue_stepper.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

#include "layout/law.h"
#include "math/archive.h"
#include "math/float_bits.h"
#include "math/number_text.h"
#include "model/fracture/toughness.h"
#include "model/scene/integrators.h"
#include "model/scene/structure_rules.h"
#include "model/scene/tool_kinds.h"
#include "solver/ticks/registry.h"
#include "solver/ticks/stable_step.h"
#include "solver/tissue/joined_lattice.h"
#include "solver/tissue/slowing.h"
#include "tools/motion_packing.h"
#include "viscera/math/error.h"
#include "viscera/model/scene/scene.h"
#include "viscera/solver/material.h"

namespace viscera {

namespace {

constexpr size_t kFinishedKept = 3;    // findings that are kept until they are requested
constexpr double kStretchSteps = 0.1;  // resolution with which the substep follows the stretch
constexpr double kAtRest = 1;          // stiffening of cells that are not strained
constexpr int kReleased = 2;           // ticks from a cut until the strain of cells that it frees was measured
constexpr int kRecoveryFactor = 2;     // over the substeps that strain needs, while cells of a law recover
constexpr double kSlowlyBack = 0.9;    // factor per tick by which the stiffening decays
constexpr double kWorthwhile = 1.01;   // growth of the stable substep from which it is taken
// Bounds of values read from a saved state, over those of this machine: of computed and of measured stable substeps.
constexpr double kRoundedHere = 0.999, kLeastMeasured = 0.5;

bool mayBurnIn(const StylusMotion& motion) {
  return motion.present && kindOf(motion.mode).burns;
}

void requireInTicks(const char* what, double value, double least, double most) {
  if (value >= least && value <= most) return;
  std::ostringstream text;
  text << "section 'ticks': " << what << " is " << value << "; " << least << " .. " << most << " is accepted";
  throw Error(text.str());
}

}  // namespace

TissueStepper::TissueStepper(const Model& model, const Scene& scene, const TickPlan& plan,
                             std::unique_ptr<SolverBackend> backend)
    : model_(model),
      backend_(std::move(backend)),
      config_(scene.solver),
      acts_(scene.styluses, plan.tick_s, resistsBlades(scene) && !cutsFreely(scene)),
      gravity_(scene.environment.gravity_m_per_s2.cast<float>()),
      tick_s_(plan.tick_s),
      attached_per_s2_(plan.attached_per_s2),
      dt_safe_s_(stepWith(plan.dt_safe_s, attached_per_s2_)),
      push_speed_m_per_s_(pushSpeed(model)),
      edge_reach_m_(edgeReach(model)),
      dashpot_ratio_(largestDashpot(model)),
      substeps_(plan.substeps),
      recovery_substeps_(plan.recovery_substeps),
      most_substeps_(std::max(plan.mostSubsteps(), plan.substeps.calm)),
      uses_stiffening_(plan.most_by_strain > 0),
      recovers_by_pd_(plan.recovers_by_pd),
      environment_(plan.environment),
      processes_(makeProcesses(scene, model, plan.tools),
                 static_cast<size_t>(SolverBackend::kGoodStates + backend_->lag())) {
  finished_.reserve(kFinishedKept);
  last_stiffening_ = kAtRest;
  if (measuresLimit(model, config_)) dt_limit_s_ = stepWith(measureLimit_s(*backend_, model), attached_per_s2_);
  if (uses_stiffening_) released_ = releasedStiffening(*backend_, model);
  replan();
  if (dt_limit_s_ > 0 && substeps_.calm > config_.max_substeps)
    throw SceneError("a tick of 1/" + numberText(config_.tick_hz) + " s needs " + std::to_string(substeps_.calm) +
                     " substeps (measured stable substep " + numberText(dt_limit_s_ * 1e6) + " us, proven " +
                     numberText(dt_safe_s_ * 1e6) +
                     " us), more than solver.max_substeps = " + std::to_string(config_.max_substeps) +
                     ". Use a larger spacing_m, a softer or heavier material, or raise solver.max_substeps");
  if (plan.governed())
    watch_.emplace(*backend_, newGovernor(), !traitsOf(config_.integrator).is_explicit, tick_s_, processes_);
  if (plan.tools) motions_.reserve(static_cast<size_t>(plan.mostSubsteps()) * layout::kMaxStyluses);
}

StabilityMonitor TissueStepper::newGovernor() const {
  return StabilityMonitor(stabilityLimits(model_, gravity_.norm(), config_.sleep_distance_m), tick_s_,
                          config_.recovery_s);
}

void TissueStepper::step(const ToolMotions& motions, const ObstacleMotions& obstacles) {
  const bool contacts = acts_.touch(motions), cuts = acts_.sever(motions);
  if (cuts || std::any_of(motions.begin(), motions.end(), mayBurnIn)) releasing_ = 1 + kReleased + backend_->lag();
  releasing_ = std::max(0, releasing_ - 1);
  chooseSubsteps();
  backend_->beginTick();
  acts_.beginTick(*backend_, motions);
  if (environment_) {
    environment_->beginTick(tick_s_, n_, obstacles);
    backend_->beginEnvironment(*environment_);
  }
  if (contacts || cuts) writeMotions(motions);
  tellOfCuts();
  const ObstacleMotions& surrounding = environment_ ? environment_->motions() : obstacles;
  const ProcessTick tick{motions, surrounding, n_, cuts, recovering_};
  processes_.beginTick(tick);
  for (int s = 0; s < n_; ++s) substep(s, tick, contacts);
  substeps_done_ += static_cast<uint64_t>(n_);
  cut_revision_ += processes_.endTick(*backend_, tick);
  if (cuts) ++cut_revision_;
  cut_revision_ += backend_->takeTorn();
  const bool undone = watch_ && applyVerdict(watch_->judgeOpen());  // of the previous tick, where the backend lags
  measureTick(motions, contacts || processes_.pushStyluses(tick));
  finishStats();
  if (watch_) applyVerdict(watch_->endTick(motions, recovering_, undone, hasLongSubsteps()));
}

void TissueStepper::writeMotions(const ToolMotions& motions) {
  interpolateMotions(motions, acts_.styluses(), n_, motions_);
  for (layout::ToolMotion& motion : motions_) motion.timing.x = static_cast<float>(tick_s_ / n_);
  for (size_t s = 0; s < layout::kMaxStyluses; ++s)
    motions_[s].timing.x = static_cast<float>(restarted_ ? 0 : last_dt_s_);
  backend_->writeMotions(motions_);
}

void TissueStepper::tellOfCuts() {
  if (processes_.readCuts() && readCuts(seen_cuts_)) processes_.cutsChanged(seen_cuts_);
}

void TissueStepper::measureTick(const ToolMotions& motions, bool contacts) {
  backend_->measure();
  if (contacts) {
    backend_->sumReactions({motions[0].to.position_m.cast<float>(), motions[1].to.position_m.cast<float>()});
    acts_.endTick(*backend_, motions);
  }
  if (environment_ && environment_->obstacleCount() > 0) backend_->sumObstacles(environment_->obstaclePositions());
  if (watch_) watch_->guard(motions, recovering_);
}

void TissueStepper::chooseSubsteps() {
  const bool recover = watch_ && watch_->health().recovering;
  const bool strained = watch_ && watch_->health().strained && !(watch_->health().only_long && dt_limit_s_ > 0);
  restarted_ |= recover != recovering_;
  recovering_ = recover;
  n_ = recover ? recovery_substeps_ : strained ? substeps_.strained : calmSubsteps();
  if (strained && !recover && uses_stiffening_) n_ = std::max(n_, calmSubsteps());
  if (recover && !recovers_by_pd_) n_ = std::min(most_substeps_, kRecoveryFactor * std::max(n_, calmSubsteps()));
}

/// Returns the substeps of a tick in which the tissue is stretched as it is now.
int TissueStepper::calmSubsteps() const {
  const double stiffening = releasing_ > 0 ? std::max(stiffening_, released_) : stiffening_;
  if (uses_stiffening_ && stiffening > 1) {
    const double dt_s = tick_s_ / substeps_.calm / lawFactor(stiffening);
    return std::clamp(static_cast<int>(std::ceil(tick_s_ / dt_s)), substeps_.calm, most_substeps_);
  }
  if (dt_limit_s_ == 0 || stretch_ == 0) return substeps_.calm;
  const double dt_s = measuredSubstep_s(config_, dashpot_ratio_, dt_safe_s_, dt_limit_s_, stretch_);
  return std::clamp(static_cast<int>(std::ceil(tick_s_ / dt_s)), substeps_.calm,
                    std::max(substeps_.calm, substeps_.strained));
}

/// Replans the substeps after dt_safe has changed.
void TissueStepper::replan() {
  SolverConfig config = config_;
  config.max_substeps = std::numeric_limits<int>::max();  // the limit was checked at the start
  substeps_ = planSubsteps(model_, config, dt_safe_s_, true);
  if (dt_limit_s_ == 0) return;
  const double dt_s = measuredSubstep_s(config_, dashpot_ratio_, dt_safe_s_, dt_limit_s_, 0);
  substeps_.calm = std::max(1, static_cast<int>(std::ceil(tick_s_ / dt_s)));
}

void TissueStepper::substep(int index, const ProcessTick& tick, bool contacts) {
  const bool moves = contacts || tick.cuts;
  if (moves) backend_->selectMotions(static_cast<size_t>(index));
  if (tick.cuts) acts_.beforeSubstep(*backend_, tick.motions);
  const double dt_s = tick_s_ / n_;
  Substep step;
  step.dt_s = static_cast<float>(dt_s);
  step.kick_s = static_cast<float>(restarted_ ? 0.5 * dt_s : 0.5 * (last_dt_s_ + dt_s));
  step.gravity = gravity_;
  step.sleep_distance_m = static_cast<float>(config_.sleep_distance_m);
  step.push_speed_m_per_s = static_cast<float>(push_speed_m_per_s_);
  step.edge_reach_m = edge_reach_m_;
  step.tools = contacts;
  step.restarted = restarted_;
  step.index = index;
  if (recovering_) step.most_step = slowedStep(watch_->setbacks());
  step.implicit = stepsByPd() || !traitsOf(config_.integrator).is_explicit;
  step.resting_speed_m_per_s = restingSpeed(step);
  if (environment_) {
    step.obstacles = environment_->at(index).obstacles;
    step.obstacle_count = static_cast<uint32_t>(environment_->obstacleCount());
  }
  if (environment_ && step.implicit && environment_->blows()) backend_->blow(step, *environment_);
  backend_->advance(step, recovering_);
  if (environment_ && (!step.implicit || environment_->features().collisions)) {
    backend_->surround(step, *environment_);
  }
  const layout::ToolMotion* const tools =
      moves ? &motions_[static_cast<size_t>(index) * layout::kMaxStyluses] : nullptr;
  cut_revision_ += processes_.act(*backend_, tick, {index, dt_s, tools});
  restarted_ = false;
  last_dt_s_ = dt_s;
}

void TissueStepper::reset() {
  if (environment_) environment_->reset();
  layout::TickStats old;
  while (backend_->takeStats(old, true)) {
  }
  finished_.clear();
  backend_->resetState();
  restarted_ = true;
  springs_cut_ = 0;
  processes_.reset();
  pulls_.clear();
  reported_pulls_ = {};
  stretch_ = stiffening_ = 0;
  releasing_ = 0;
  last_stiffening_ = kAtRest;
  dt_safe_s_ = stepWith(safeTimeStep(model_), attached_per_s2_);
  replan();
  if (watch_) watch_->reset(newGovernor());
  ++cut_revision_;
  if (start_) writeState(*start_);
}

void TissueStepper::startFrom(HostState state) {
  start_ = std::move(state);
  writeState(*start_);
}

void TissueStepper::writeState(const HostState& state, bool staggered) {
  if (watch_) applyVerdict(watch_->judgeOpen());
  backend_->loadState(state);
  restarted_ = !staggered || traitsOf(config_.integrator).own_positions;
  if (staggered && last_dt_s_ == 0) last_dt_s_ = dt_s();
  if (staggered) recovering_ = false;
  ++cut_revision_;
  last_stiffening_ = 0;  // it may have got there in any time
  if (watch_) recordStretch(watch_->restart());
}

/// @throws Error  a saved number that this model's ticks cannot have
void TissueStepper::persistSubsteps(Archive& archive) {
  const double least_safe_s = dt_safe_s_ * kRoundedHere;
  archive.value(dt_safe_s_);
  double limit_s = dt_limit_s_;  // a reset does not measure it again
  archive.value(limit_s);
  archive.value(stretch_);
  archive.value(stiffening_);
  archive.value(last_stiffening_);
  archive.value(substeps_);
  archive.value(substeps_done_);
  archive.value(springs_cut_);
  archive.value(n_);
  archive.value(recovering_);
  archive.value(restarted_);
  archive.value(last_dt_s_);
  archive.value(releasing_);
  if (!archive.reads()) return;
  constexpr double kAny = std::numeric_limits<double>::infinity();
  requireInTicks("stable substep [s]", dt_safe_s_, least_safe_s, kAny);
  requireInTicks("measured stable substep [s]", limit_s, kLeastMeasured * dt_limit_s_, dt_limit_s_ / kLeastMeasured);
  requireInTicks("stiffening", stiffening_, 0, layout::kMostStiffening);
  requireInTicks("last stiffening", last_stiffening_, 0, layout::kMostStiffening);
  requireInTicks("stretch", stretch_, 0, std::numeric_limits<float>::max());
  requireInTicks("calm substeps", substeps_.calm, 1, most_substeps_);
  requireInTicks("strained substeps", substeps_.strained, 1, most_substeps_);
  requireInTicks("substeps of the last tick", n_, 1, most_substeps_);
  requireInTicks("last substep [s]", last_dt_s_, 0, tick_s_);
  requireInTicks("ticks after a cut", releasing_, 0, kReleased + backend_->lag());
  dt_limit_s_ = limit_s;
}

/// Discards measurements that were not requested: they do not affect later ticks.
void TissueStepper::persist(Archive& archive) {
  layout::TickStats taken;
  while (pollStats(taken, true)) {
  }
  archive.section("ticks");
  persistSubsteps(archive);
  if (environment_) environment_->persist(archive);
  processes_.persist(archive);
  backend_->persist(archive);
  if (watch_) watch_->persist(archive);
  if (archive.reads()) ++cut_revision_;
}

bool TissueStepper::readCuts(CutState& out) const {
  if (!out.nodes.empty() && out.revision == cut_revision_) return false;
  backend_->readCuts(out);
  out.revision = cut_revision_;
  return true;
}

/// Starts the transfer of a tick's measurements. Where the backend is as far behind as allowed, waits here, which keeps
/// the two in step.
void TissueStepper::finishStats() {
  if (!backend_->requestStats()) {
    TickFindings oldest;
    takeStats(oldest, true);
    keepStats(oldest);
    backend_->requestStats();
  }
  if (!watch_ && !processes_.all().empty()) pulls_.push_back(processes_.pulls());
}

bool TissueStepper::takeStats(TickFindings& findings, bool wait) {
  if (!backend_->takeStats(findings.stats, wait)) return false;
  findings.pulls = {};
  if (!pulls_.empty()) {
    findings.pulls = pulls_.front();
    addTo(findings.stats, findings.pulls);
    pulls_.erase(pulls_.begin());
  }
  return true;
}

/// Keeps findings until they are requested; of more than kFinishedKept the oldest is discarded.
void TissueStepper::keepStats(const TickFindings& findings) {
  if (finished_.size() == kFinishedKept) finished_.erase(finished_.begin());
  finished_.push_back(findings);
}

/// Applies a verdict. @returns whether there was a roll-back
bool TissueStepper::applyVerdict(const RollbackGuard::Verdict& verdict) {
  if (verdict.published) keepStats(*verdict.published);
  if (verdict.good) {
    recordStretch(*verdict.good);
    relaxSubsteps(*verdict.good);
  }
  restarted_ |= verdict.rolled_back;
  if (!verdict.rolled_back) return false;
  seen_cuts_.nodes.clear();  // restored suture tracks were embedded under older cuts: embed again
  cut_revision_ += processes_.restart(*backend_);
  return true;
}

/// Records the stretch, rounded down: substeps that change in every tick make small forces flicker, and there is a
/// margin.
void TissueStepper::recordStretch(const layout::TickStats& stats) {
  // Cells that tools squeeze are stiffer still by the tick in which this value is used.
  const double stiffening = static_cast<double>(floatFromBits(stats.max_stiffening_bits));
  const double grown = std::max(0.0, stiffening - last_stiffening_) * (1 + backend_->lag());
  last_stiffening_ = stiffening;
  const double most = static_cast<double>(layout::kMostStiffening);
  stiffening_ = std::min(most, std::max(stiffening + grown, kSlowlyBack * stiffening_));
  stretch_ = std::floor(static_cast<double>(floatFromBits(stats.max_stretch_bits)) / kStretchSteps) * kStretchSteps;
}

bool TissueStepper::hasLongSubsteps() const {
  return dt_limit_s_ > 0 && !recovering_ && tick_s_ / n_ > config_.dt_fraction * dt_safe_s_;
}

/// Replans after cuts. A cut removes springs and no mass, so the stable substep can only grow.
void TissueStepper::relaxSubsteps(const layout::TickStats& stats) {
  if (stats.springs_cut == springs_cut_) return;
  springs_cut_ = stats.springs_cut;
  const float rate = floatFromBits(stats.max_rate_bits);
  if (rate <= 0) return;
  const double dt_safe_s = stepWith(2 / std::sqrt(static_cast<double>(rate)), attached_per_s2_);
  if (dt_safe_s < kWorthwhile * dt_safe_s_) return;
  dt_safe_s_ = dt_safe_s;
  replan();
}

double TissueStepper::velocityLag_s() {
  if (watch_ && watch_->openIsBad()) return 0;  // the state was restored already
  const bool lags = traitsOf(config_.integrator).staggered && !recovering_ && !restarted_;
  return lags ? 0.5 * last_dt_s_ : 0;
}

const Health& TissueStepper::health() const {
  static const Health kUnwatched;
  return watch_ ? watch_->health() : kUnwatched;
}

bool TissueStepper::pollStats(layout::TickStats& stats, bool wait) {
  TickFindings findings;
  if (!finished_.empty()) {
    findings = finished_.front();
    finished_.erase(finished_.begin());
  } else if (!(watch_ ? watch_->poll(findings, wait) : takeStats(findings, wait))) {
    return false;
  }
  stats = findings.stats;
  reported_pulls_ = findings.pulls;
  return true;
}

}  // namespace viscera
