// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "viscera/solver/gpu/gpu_solver.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "viscera/math/error.h"

namespace viscera {

namespace {

constexpr int kStatsInFlight = 3;
constexpr double kWorthwhile = 1.01;     // a stable substep must have grown by this factor to be taken
constexpr int kGoodStates = 4;           // ticks that can be rolled back; each costs 32 bytes per slot
constexpr int kRecoveryIterations = 20;  // sweeps per recovery substep: as many in a tick as leapfrog has substeps

bool isCut(ToolMode mode) {
  return mode == ToolMode::kCut || mode == ToolMode::kCutParticles;
}
bool isContact(ToolMode mode) {
  return mode == ToolMode::kProbe || mode == ToolMode::kGrab;
}

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

std::vector<layout::BodyParams> allParams(const Model& model, double dt_safe_s) {
  std::vector<layout::BodyParams> out;
  for (const Body& body : model.bodies) out.push_back(bodyParams(body, dt_safe_s));
  return out;
}

}  // namespace

GpuSolver::GpuSolver(const Model& model, const Scene& scene, const GpuSolverOptions& options)
    : model_(model),
      config_(scene.solver),
      styluses_(scene.styluses),
      gravity_(scene.environment.gravity_m_per_s2.cast<float>()),
      tick_s_(1 / scene.solver.tick_hz),
      dt_safe_s_(safeTimeStep(model)),
      push_speed_m_per_s_(pushSpeed(model)),
      plan_(planSubsteps(model, scene.solver, dt_safe_s_, options.allow_unstable)),
      features_(featuresOf(model, scene, tick_s_ / plan_.strained, options.group_size)),
      buffers_(model, allParams(model, dt_safe_s_), features_),
      stepper_(makeStepper(scene.solver.integrator, scene.solver.iterations, features_, buffers_)),
      measure_(features_, buffers_.active_count),
      stats_ring_(sizeof(layout::TickStats), kStatsInFlight) {
  finished_.reserve(kStatsInFlight);
  int most = plan_.strained;
  if (config_.governor) {
    const double fall = scene.environment.gravity_m_per_s2.norm();
    const int recovery_substeps = std::max(1, plan_.strained / kRecoveryIterations);
    most = std::max(most, recovery_substeps);
    watch_.emplace(Watch{Governor(governorLimits(model, fall, config_.sleep_distance_m), tick_s_, config_.recovery_s),
                         GoodStates(buffers_.slot_count, kGoodStates),
                         makeRecoveryStepper(kRecoveryIterations, features_, buffers_),
                         recovery_substeps,
                         {}});
    watch_->good.save(buffers_);
  }
  if (!styluses_.empty()) {
    tools_.emplace(Tools{gpu::Buffer<layout::ToolMotion>(static_cast<size_t>(most) * layout::kMaxStyluses),
                         GrabPass(features_), CutPass(features_), ReactionPass(features_, buffers_.active_count)});
  }
}

void GpuSolver::step(const ToolMotions& motions) {
  chooseStepper();
  buffers_.bind();
  bool contacts = false, cuts = false;
  if (tools_) {
    changeGrips(motions);
    for (const StylusMotion& motion : motions) {
      contacts |= isContact(motion.mode);
      cuts |= isCut(motion.mode);
    }
  }
  if (contacts || cuts) {
    interpolateMotions(motions, styluses_, n_, motions_);
    tools_->motions.write(motions_);
  }
  if (cuts) ++cut_revision_;
  for (int s = 0; s < n_; ++s) substep(static_cast<size_t>(s), motions, contacts);
  measure_.run(buffers_);
  if (contacts) {
    tools_->reaction.run(buffers_, {motions[0].to.position_m.cast<float>(), motions[1].to.position_m.cast<float>()});
  }
  ++tick_;
  substeps_done_ += static_cast<uint64_t>(n_);
  queueStats();
  if (watch_) govern(motions);
}

void GpuSolver::chooseStepper() {
  const bool recovering = watch_ && watch_->governor.health().recovering;
  const bool strained = watch_ && watch_->governor.health().strained;
  Stepper* const wanted = recovering ? watch_->recovery.get() : stepper_.get();
  restarted_ |= wanted != active_;
  active_ = wanted;
  n_ = recovering ? watch_->recovery_substeps : strained ? plan_.strained : plan_.calm;
}

void GpuSolver::changeGrips(const ToolMotions& motions) {
  for (uint32_t s = 0; s < styluses_.size(); ++s) {
    if (motions[s].grab_ends) tools_->grab.letGo(buffers_, s, styluses_[s].release_speed_m_per_s);
    if (motions[s].grab_begins) tools_->grab.takeHold(buffers_, s, motions[s].from, styluses_[s].grab_radius_m);
  }
}

void GpuSolver::substep(size_t index, const ToolMotions& motions, bool contacts) {
  if (tools_) {
    tools_->motions.bindUniform(layout::kBindToolMotions, index * layout::kMaxStyluses, layout::kMaxStyluses);
    cut(motions);
  }
  const double dt_s = tick_s_ / n_;
  Substep step;
  step.dt_s = static_cast<float>(dt_s);
  step.kick_s = static_cast<float>(restarted_ ? 0.5 * dt_s : 0.5 * (last_dt_s_ + dt_s));
  step.gravity = gravity_;
  step.sleep_distance_m = static_cast<float>(config_.sleep_distance_m);
  step.push_speed_m_per_s = static_cast<float>(push_speed_m_per_s_);
  step.tools = contacts;
  step.restarted = restarted_;
  active_->run(buffers_, step);
  restarted_ = false;
  last_dt_s_ = dt_s;
  buffers_.swap();
  buffers_.bind();
}

void GpuSolver::cut(const ToolMotions& motions) {
  for (uint32_t s = 0; s < styluses_.size(); ++s) {
    if (!isCut(motions[s].mode)) continue;
    tools_->cut.run(buffers_, s, motions[s].mode == ToolMode::kCutParticles);
  }
}

void GpuSolver::reset() {
  stats_ring_.drop();
  finished_.clear();
  buffers_.reset();
  restarted_ = true;
  tick_ = 0;
  springs_cut_ = 0;
  dt_safe_s_ = safeTimeStep(model_);
  plan_ = planSubsteps(model_, config_, dt_safe_s_, true);
  if (watch_) {
    watch_->governor =
        Governor(governorLimits(model_, gravity_.norm(), config_.sleep_distance_m), tick_s_, config_.recovery_s);
    watch_->good.clear();
    watch_->good.save(buffers_);
  }
  ++cut_revision_;
}

StateView GpuSolver::state() const {
  StateView view;
  view.displacement = buffers_.displacement[buffers_.current].id();
  view.velocity = buffers_.velocity[buffers_.current].id();
  view.nodes = buffers_.nodes.id();
  view.bricks = buffers_.bricks.id();
  view.bodies = buffers_.bodies.id();
  view.cut_revision = cut_revision_;
  return view;
}

HostState GpuSolver::readState() const {
  return {buffers_.displacement[buffers_.current].read(), buffers_.velocity[buffers_.current].read(),
          buffers_.nodes.read()};
}

void GpuSolver::writeState(const HostState& state, bool staggered) {
  buffers_.displacement[buffers_.current].write(state.displacement_m);
  buffers_.velocity[buffers_.current].write(state.velocity_m_per_s);
  buffers_.nodes.write(state.nodes);
  if (buffers_.compensation.size()) buffers_.compensation.clear();
  restarted_ = !staggered || config_.integrator == Integrator::kVerletPaper;  // it keeps positions of its own
  if (staggered && last_dt_s_ == 0) last_dt_s_ = dt_s();
  if (staggered) active_ = stepper_.get();
  ++cut_revision_;
  if (!watch_) return;
  buffers_.bind();
  measure_.run(buffers_);
  watch_->last_good = buffers_.stats.read()[0];
  watch_->governor.restart(watch_->last_good);
  watch_->good.clear();
  watch_->good.save(buffers_);
}

void GpuSolver::queueStats() {
  const gpu::ReadbackRing::Source source{buffers_.stats.id(), 0, sizeof(layout::TickStats)};
  if (stats_ring_.request(source, tick_)) return;
  // The GPU is as many ticks behind as the ring is deep: waiting here is what keeps the two together.
  layout::TickStats stats;
  takeStats(stats, true);
  finished_.push_back(stats);
  stats_ring_.request(source, tick_);
}

bool GpuSolver::takeStats(layout::TickStats& stats, bool wait) {
  const void* memory = stats_ring_.collect(nullptr, wait);
  if (!memory) return false;
  std::memcpy(&stats, memory, sizeof stats);
  stats_ring_.release();
  return true;
}

/// Ends a tick: keeps a good state, rolls a bad one back. Waits for the tick's measurements, so that what follows does
/// not depend on how far the GPU is behind.
void GpuSolver::govern(const ToolMotions& motions) {
  layout::TickStats stats;
  takeStats(stats, true);
  const bool was_recovering = watch_->governor.health().recovering;
  const bool implicit = was_recovering || !isExplicit(config_.integrator);
  if (watch_->governor.judge(stats, implicit, workOfTools(stats, motions, tick_s_)) == Governor::Trip::kNone) {
    watch_->good.save(buffers_);
    watch_->last_good = stats;
    relaxSubsteps(stats);
  } else {
    watch_->good.restore(buffers_, watch_->governor.setbacks() - 1);
    restarted_ = true;
    if (buffers_.impulses.size()) buffers_.impulses.clear();
    const uint32_t springs_cut = stats.springs_cut;
    stats = watch_->last_good;
    stats.springs_cut = springs_cut;
  }
  if (was_recovering || watch_->governor.health().recovering) {  // no force while the tissue is not itself
    for (uint32_t s = 0; s < layout::kMaxStyluses; ++s) stats.impulse[s] = stats.angular[s] = {};
  }
  if (finished_.size() == kStatsInFlight) finished_.erase(finished_.begin());
  finished_.push_back(stats);
}

/// A cut takes springs and no mass, so the stable substep can only grow.
void GpuSolver::relaxSubsteps(const layout::TickStats& stats) {
  if (stats.springs_cut == springs_cut_) return;
  springs_cut_ = stats.springs_cut;
  float rate;
  std::memcpy(&rate, &stats.max_rate_bits, sizeof rate);
  if (rate <= 0) return;
  const double dt_safe_s = 2 / std::sqrt(static_cast<double>(rate));
  if (dt_safe_s < kWorthwhile * dt_safe_s_) return;
  dt_safe_s_ = dt_safe_s;
  plan_ = planSubsteps(model_, config_, dt_safe_s_, true);
}

double GpuSolver::velocityLag_s() const {
  const bool lags = config_.integrator == Integrator::kLeapfrog && active_ == stepper_.get() && !restarted_;
  return lags ? 0.5 * last_dt_s_ : 0;
}

const Health& GpuSolver::health() const {
  static const Health kUnwatched;
  return watch_ ? watch_->governor.health() : kUnwatched;
}

bool GpuSolver::pollStats(layout::TickStats& stats, bool wait) {
  if (finished_.empty()) return takeStats(stats, wait);
  stats = finished_.front();
  finished_.erase(finished_.begin());
  return true;
}

}  // namespace viscera
