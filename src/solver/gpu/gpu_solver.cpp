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

bool isCut(ToolMode mode) {
  return mode == ToolMode::kCut || mode == ToolMode::kCutParticles;
}
bool isContact(ToolMode mode) {
  return mode == ToolMode::kProbe || mode == ToolMode::kGrab;
}

std::vector<layout::BodyParams> allParams(const Model& model, double dt_safe_s) {
  std::vector<layout::BodyParams> out;
  for (const Body& body : model.bodies) out.push_back(bodyParams(body, dt_safe_s));
  return out;
}

FeatureSet featuresOf(const Model& model, uint32_t group_size) {
  FeatureSet features;
  features.group_size = group_size;
  features.single_body = model.bodies.size() == 1;
  for (const Body& body : model.bodies) features.dashpot |= body.material.dashpot_ratio > 0;
  return features;
}

int substepsPerTick(const SolverConfig& config, double dt_safe_s) {
  const double wanted = std::ceil(1.0 / (config.tick_hz * config.dt_fraction * dt_safe_s));
  if (wanted > config.max_substeps) {
    throw SceneError("a tick of 1/" + std::to_string(config.tick_hz) + " s needs " +
                     std::to_string(std::lround(wanted)) + " substeps (stable substep " +
                     std::to_string(dt_safe_s * 1e6) +
                     " us), more than solver.max_substeps = " + std::to_string(config.max_substeps) +
                     ": use a larger spacing_m, a softer or heavier material, or raise solver.max_substeps");
  }
  return std::max(1, static_cast<int>(wanted));
}

}  // namespace

GpuSolver::GpuSolver(const Model& model, const Scene& scene, uint32_t group_size)
    : styluses_(scene.styluses),
      gravity_(scene.environment.gravity_m_per_s2.cast<float>()),
      dt_safe_s_(safeTimeStep(model)),
      substeps_(substepsPerTick(scene.solver, dt_safe_s_)),
      buffers_(model, allParams(model, dt_safe_s_), !scene.styluses.empty()),
      integrate_(featuresOf(model, group_size)),
      measure_(featuresOf(model, group_size)),
      stats_ring_(sizeof(layout::TickStats), kStatsInFlight) {
  finished_.reserve(kStatsInFlight);
  dt_s_ = 1.0 / (scene.solver.tick_hz * substeps_);
  const FeatureSet features = featuresOf(model, group_size);
  if (!styluses_.empty()) {
    tools_.emplace(Tools{gpu::Buffer<layout::ToolMotion>(static_cast<size_t>(substeps_) * layout::kMaxStyluses),
                         GrabPass(features), CutPass(features), ReactionPass(features, buffers_.active_count)});
  }
}

void GpuSolver::step(const ToolMotions& motions) {
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
    interpolateMotions(motions, styluses_, substeps_, motions_);
    tools_->motions.write(motions_);
  }
  if (cuts) ++cut_revision_;
  for (int s = 0; s < substeps_; ++s) substep(static_cast<size_t>(s), motions, contacts);
  measure_.run(buffers_);
  if (contacts) {
    tools_->reaction.run(buffers_, {motions[0].to.position_m.cast<float>(), motions[1].to.position_m.cast<float>()});
  }
  ++tick_;
  queueStats();
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
  IntegratePass::Step step{static_cast<float>(dt_s_), static_cast<float>(first_substep_ ? 0.5 * dt_s_ : dt_s_),
                           gravity_, contacts};
  integrate_.run(buffers_, step);
  first_substep_ = false;
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
  first_substep_ = true;
  tick_ = 0;
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
  first_substep_ = !staggered;
  ++cut_revision_;
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

bool GpuSolver::pollStats(layout::TickStats& stats, bool wait) {
  if (finished_.empty()) return takeStats(stats, wait);
  stats = finished_.front();
  finished_.erase(finished_.begin());
  return true;
}

}  // namespace viscera
