// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "solver/gpu/gpu_backend.h"

#include <cmath>
#include <cstring>

#include "gpu/program.h"
#include "gpu/stage_clock.h"
#include "layout/bindings.h"
#include "viscera/gpu/context.h"
#include "viscera/math/error.h"
#include "viscera/solver/material.h"

namespace viscera {

namespace {
constexpr int kStatsInFlight = 3;
}

GpuBackend::GpuBackend(const Model& model, const Scene& scene, const TickPlan& plan, const GpuSolverOptions& options)
    : features_(featuresOf(model, scene, plan.shortestSubstep_s(), options.group_size)),
      buffers_(model, bodyParams(model, plan.dt_safe_s), features_),
      pairs_(solvesContacts(scene) ? std::make_unique<NodePairs>(model, scene, features_, buffers_) : nullptr),
      stepper_(makeStepper(scene.solver.integrator, scene.solver.iterations, features_, buffers_, pairs_.get())),
      measure_(features_, buffers_.store.active_count),
      has_springs_(std::isfinite(plan.dt_safe_s) && plan.dt_safe_s > 0),
      stats_ring_(sizeof(layout::TickStats), kStatsInFlight, "the measurements of a tick") {
  if (plan.governed()) {
    recovery_.emplace(Recovery{GoodStates(buffers_.store.slot_count, kGoodStates + kLag), GuardPass(features_),
                               makeRecoveryStepper(kRecoveryIterations, features_, buffers_)});
    recovery_->good.save(buffers_);
  }
  if (plan.surroundings) surroundings_.emplace(model, scene, features_, buffers_);
  if (features_.obstacles > 0) obstacle_reaction_.emplace(features_, buffers_.store.active_count, true);
  if (plan.tools) {
    const size_t rows = static_cast<size_t>(plan.mostSubsteps()) * layout::kMaxStyluses;
    tools_.emplace(Tools{gpu::Buffer<layout::ToolMotion>(rows, "tool motions"), GrabPass(features_), CutPass(features_),
                         ReactionPass(features_, buffers_.store.active_count)});
  }
}

void GpuBackend::beginTick() {
  buffers_.bind();
}

void GpuBackend::takeHold(uint32_t stylus, const Pose& pose, double radius_m) {
  tools_->grab.takeHold(buffers_, stylus, pose, radius_m);
}

void GpuBackend::letGo(uint32_t stylus, const Release& release) {
  tools_->grab.letGo(buffers_, stylus, release);
}

void GpuBackend::writeMotions(const std::vector<layout::ToolMotion>& motions) {
  tools_->motions.write(motions);
}

void GpuBackend::selectMotions(size_t substep) {
  tools_->motions.bindUniform(layout::kBindToolMotions, substep * layout::kMaxStyluses, layout::kMaxStyluses);
}

void GpuBackend::cut(uint32_t stylus, bool particles) {
  const gpu::TimedStage timed(gpu::Stage::kCut);
  tools_->cut.run(buffers_, stylus, particles);
}

void GpuBackend::advance(const Substep& step, bool recovery) {
  const gpu::TimedStage timed(gpu::Stage::kStep);
  Stepper& stepper = recovery ? *recovery_->stepper : *stepper_;
  if (surroundings_ && step.implicit) surroundings_->bindObstacles(step);
  stepper.run(buffers_, step);
  buffers_.swap();
}

void GpuBackend::beginSurroundings(const Surroundings& surroundings) {
  surroundings_->beginTick(surroundings);
}

void GpuBackend::blow(const Substep& step, const Surroundings& surroundings) {
  const gpu::TimedStage timed(gpu::Stage::kStep);
  surroundings_->blow(buffers_, step, surroundings);
}

void GpuBackend::sumObstacles(const std::vector<Vector3f>& places) {
  const gpu::TimedStage timed(gpu::Stage::kReaction);
  obstacle_reaction_->runObstacles(buffers_, places);
}

void GpuBackend::surround(const Substep& step, const Surroundings& surroundings) {
  const gpu::TimedStage timed(gpu::Stage::kStep);
  surroundings_->run(buffers_, step, surroundings);
}

void GpuBackend::measure() {
  const gpu::TimedStage timed(gpu::Stage::kMeasure);
  measure_.run(buffers_);
}

void GpuBackend::sumReactions(const std::array<Vector3f, layout::kMaxStyluses>& tips) {
  const gpu::TimedStage timed(gpu::Stage::kReaction);
  tools_->reaction.run(buffers_, tips);
}

void GpuBackend::guard(const Governor::Bounds& bounds, const ToolMotions& motions, double tick_s) {
  const gpu::TimedStage timed(gpu::Stage::kMeasure);
  recovery_->good.bindLast();
  recovery_->guard.run(buffers_, bounds, motions, tick_s);
}

/// The end of a tick. Here OpenGL's errors come to light: to ask after each call would cost.
bool GpuBackend::requestStats() {
  gpu::checkErrors("a tick of the solver");
  return stats_ring_.request({buffers_.stats.id(), 0, sizeof(layout::TickStats)}, 0);
}

bool GpuBackend::takeStats(layout::TickStats& stats, bool wait) {
  const void* memory = stats_ring_.collect(nullptr, wait);
  if (!memory) return false;
  std::memcpy(&stats, memory, sizeof stats);
  stats_ring_.release();
  if (has_springs_ && !foreign_) requireSignOfLife(stats);
  return true;
}

void requireSignOfLife(const layout::TickStats& stats) {
  if (stats.max_rate_bits != 0 || stats.springs_cut != 0 || stats.nonfinite != 0) return;
  throw GpuError(
      "the GPU does not step the tissue: its measurements are empty (out of memory, or a driver that gave up; last "
      "kernel '" +
      gpu::lastKernel() + "')");
}

std::optional<StateView> GpuBackend::stateOnGpu(uint64_t cut_revision) const {
  StateView view;
  view.displacement = buffers_.state.displacement[buffers_.state.current].id();
  view.velocity = buffers_.state.velocity[buffers_.state.current].id();
  view.nodes = buffers_.store.nodes.id();
  view.bricks = buffers_.store.bricks.id();
  view.bodies = buffers_.store.bodies.id();
  view.rest = buffers_.links.rest.id();
  view.spring_cut = buffers_.links.spring_cut.id();
  view.axial_cut = buffers_.axial_cut.id();
  view.cut_revision = cut_revision;
  return view;
}

HostState GpuBackend::readState() const {
  HostState out;
  out.displacement_m = buffers_.state.displacement[buffers_.state.current].read();
  out.velocity_m_per_s = buffers_.state.velocity[buffers_.state.current].read();
  out.nodes = buffers_.store.nodes.read();
  out.spring_cut = buffers_.links.spring_cut.read();
  out.axial_cut = buffers_.readAxialCut(out.spring_cut);
  return out;
}

void GpuBackend::readCuts(CutState& out) const {
  out.nodes = buffers_.store.nodes.read();
  out.spring_cut = buffers_.links.spring_cut.read();
  out.axial_cut = buffers_.readAxialCut(out.spring_cut);
}

void GpuBackend::resetState() {
  foreign_ = false;
  buffers_.reset();
  if (surroundings_) surroundings_->restart();
  if (pairs_) pairs_->restart();
}

void GpuBackend::loadState(const HostState& state) {
  foreign_ = true;
  buffers_.state.displacement[buffers_.state.current].write(state.displacement_m);
  buffers_.state.velocity[buffers_.state.current].write(state.velocity_m_per_s);
  buffers_.store.nodes.write(state.nodes);
  buffers_.writeSpringCut(state.spring_cut);
  buffers_.writeAxialCut(state.axial_cut);
  if (buffers_.state.compensation.size()) buffers_.state.compensation.clear();
  if (surroundings_) surroundings_->restart();
  if (pairs_) pairs_->restart();
  buffers_.bind();
}

void GpuBackend::saveGood() {
  const gpu::TimedStage timed(gpu::Stage::kMeasure);
  recovery_->good.save(buffers_);
}

void GpuBackend::restoreGood(int back) {
  recovery_->good.restore(buffers_, back);
  if (buffers_.hands.impulses.size()) buffers_.hands.impulses.clear();
  if (buffers_.hands.obstacle_impulses.size()) buffers_.hands.obstacle_impulses.clear();
  if (surroundings_) surroundings_->restart();
  if (pairs_) pairs_->restart();
}

void GpuBackend::clearGood() {
  recovery_->good.clear();
}

}  // namespace viscera
