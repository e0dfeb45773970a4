// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "solver/gpu/gpu_solver.h"

#include <cstring>

#include "gpu/stage_clock.h"
#include "layout/bindings.h"
#include "viscera/math/error.h"

namespace viscera {

namespace {
constexpr int kStatsInFlight = 3;
}

GpuSolver::GpuSolver(const Model& model, const Scene& scene, const GpuSolverOptions& options)
    : LatticeSolver(model, scene, options),
      features_(featuresOf(model, scene, shortestSubstep_s(), options.group_size)),
      buffers_(model, bodyParams(model, dtSafe_s()), features_),
      stepper_(makeStepper(scene.solver.integrator, scene.solver.iterations, features_, buffers_)),
      measure_(features_, buffers_.store.active_count),
      stats_ring_(sizeof(layout::TickStats), kStatsInFlight) {
  if (governed()) {
    recovery_.emplace(Recovery{GoodStates(buffers_.store.slot_count, kGoodStates + lag()), GuardPass(features_),
                               makeRecoveryStepper(kRecoveryIterations, features_, buffers_)});
    recovery_->good.save(buffers_);
  }
  if (hasSurroundings()) surroundings_.emplace(model, scene, features_, buffers_);
  if (hasTools()) {
    const size_t rows = static_cast<size_t>(mostSubsteps()) * layout::kMaxStyluses;
    tools_.emplace(Tools{gpu::Buffer<layout::ToolMotion>(rows), GrabPass(features_), CutPass(features_),
                         ReactionPass(features_, buffers_.store.active_count)});
  }
}

void GpuSolver::beginTick() {
  buffers_.bind();
}

void GpuSolver::takeHold(uint32_t stylus, const Pose& pose, double radius_m) {
  tools_->grab.takeHold(buffers_, stylus, pose, radius_m);
}

void GpuSolver::letGo(uint32_t stylus, const Release& release) {
  tools_->grab.letGo(buffers_, stylus, release);
}

void GpuSolver::writeMotions(const std::vector<layout::ToolMotion>& motions) {
  tools_->motions.write(motions);
}

void GpuSolver::selectMotions(size_t substep) {
  tools_->motions.bindUniform(layout::kBindToolMotions, substep * layout::kMaxStyluses, layout::kMaxStyluses);
}

void GpuSolver::cut(uint32_t stylus, bool particles) {
  const gpu::TimedStage timed(gpu::Stage::kCut);
  tools_->cut.run(buffers_, stylus, particles);
}

void GpuSolver::advance(const Substep& step, bool recovery) {
  const gpu::TimedStage timed(gpu::Stage::kStep);
  Stepper& stepper = recovery ? *recovery_->stepper : *stepper_;
  stepper.run(buffers_, step);
  buffers_.swap();
}

void GpuSolver::beginSurroundings(const Surroundings& surroundings) {
  surroundings_->beginTick(surroundings);
}

void GpuSolver::surround(const Substep& step, const Surroundings& surroundings) {
  const gpu::TimedStage timed(gpu::Stage::kStep);
  surroundings_->run(buffers_, step, surroundings);
}

void GpuSolver::measure() {
  const gpu::TimedStage timed(gpu::Stage::kMeasure);
  measure_.run(buffers_);
}

void GpuSolver::sumReactions(const std::array<Vector3f, layout::kMaxStyluses>& tips) {
  const gpu::TimedStage timed(gpu::Stage::kReaction);
  tools_->reaction.run(buffers_, tips);
}

void GpuSolver::guard(const Governor::Bounds& bounds, const ToolMotions& motions, double tick_s) {
  const gpu::TimedStage timed(gpu::Stage::kMeasure);
  recovery_->good.bindLast();
  recovery_->guard.run(buffers_, bounds, motions, tick_s);
}

bool GpuSolver::requestStats() {
  return stats_ring_.request({buffers_.stats.id(), 0, sizeof(layout::TickStats)}, 0);
}

bool GpuSolver::takeStats(layout::TickStats& stats, bool wait) {
  const void* memory = stats_ring_.collect(nullptr, wait);
  if (!memory) return false;
  std::memcpy(&stats, memory, sizeof stats);
  stats_ring_.release();
  return true;
}

StateView GpuSolver::state() const {
  StateView view;
  view.displacement = buffers_.state.displacement[buffers_.state.current].id();
  view.velocity = buffers_.state.velocity[buffers_.state.current].id();
  view.nodes = buffers_.store.nodes.id();
  view.bricks = buffers_.store.bricks.id();
  view.bodies = buffers_.store.bodies.id();
  view.rest = buffers_.links.rest.id();
  view.spring_cut = buffers_.links.spring_cut.id();
  view.cut_revision = cutRevision();
  return view;
}

HostState GpuSolver::readState() const {
  return {buffers_.state.displacement[buffers_.state.current].read(),
          buffers_.state.velocity[buffers_.state.current].read(), buffers_.store.nodes.read(),
          buffers_.links.spring_cut.read()};
}

void GpuSolver::resetState() {
  buffers_.reset();
}

void GpuSolver::loadState(const HostState& state) {
  buffers_.state.displacement[buffers_.state.current].write(state.displacement_m);
  buffers_.state.velocity[buffers_.state.current].write(state.velocity_m_per_s);
  buffers_.store.nodes.write(state.nodes);
  buffers_.writeSpringCut(state.spring_cut);
  if (buffers_.state.compensation.size()) buffers_.state.compensation.clear();
  buffers_.bind();
}

void GpuSolver::saveGood() {
  const gpu::TimedStage timed(gpu::Stage::kMeasure);
  recovery_->good.save(buffers_);
}

void GpuSolver::restoreGood(int back) {
  recovery_->good.restore(buffers_, back);
  if (buffers_.hands.impulses.size()) buffers_.hands.impulses.clear();
}

void GpuSolver::clearGood() {
  recovery_->good.clear();
}

}  // namespace viscera
