// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "solver/gpu/gpu_backend.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <utility>

#include "gpu/program.h"
#include "gpu/stage_clock.h"
#include "layout/bindings.h"
#include "layout/blade.h"
#include "math/archive.h"
#include "model/fracture/toughness.h"
#include "model/scene/integrators.h"
#include "model/scene/tool_kinds.h"
#include "solver/cpu/state/sleep.h"
#include "solver/ticks/registry.h"
#include "viscera/gpu/context.h"
#include "viscera/math/error.h"
#include "viscera/model/scene/scene.h"
#include "viscera/solver/material.h"

namespace viscera {

namespace {

constexpr int kStatsInFlight = 3;
const float kFarthestCut = layout::kLongest * 1.41421357f;  // spacings from a blade in which it may cut

/// Returns null if nothing may sleep: with other integrators, or with an environment that moves tissue at rest.
std::unique_ptr<AwakeBricks> makeAwakeBricks(const Model& model, const Scene& scene, const TickPlan& plan,
                                             const FeatureSet& features, const LatticeBuffers& buffers) {
  const double speed_m_per_s = scene.solver.sleep_speed_m_per_s;
  if (!traitsOf(scene.solver.integrator).lets_bricks_sleep || plan.staysAwake() || speed_m_per_s <= 0) return nullptr;
  if (!features.lattice || !AwakeBricks::fits(features)) return nullptr;
  return std::make_unique<AwakeBricks>(model, features, buffers, speed_m_per_s);
}

}  // namespace

GpuBackend::GpuBackend(const Model& model, const Scene& scene, const TickPlan& plan, const GpuSolverOptions& options)
    : features_(featuresOf(model, scene, plan.shortestSubstep_s(), options.group_size)),
      buffers_(model, bodyParams(model, plan.dt_safe_s), features_),
      pairs_(solvesContacts(scene) ? std::make_unique<NodePairs>(model, scene, features_, buffers_) : nullptr),
      awake_(makeAwakeBricks(model, scene, plan, features_, buffers_)),
      rest_(model, awake_ && !features_.network && plan.tick_s < Sleep::kQuiet_s &&
                       processesAct(scene, model, plan.tools) != ProcessActs::kAlways),
      stepper_(makeStepper(scene.solver.integrator, scene.solver.iterations, features_, buffers_, pairs_.get(),
                           awake_.get())),
      measure_(features_, buffers_.store.active_count),
      has_springs_(std::isfinite(plan.dt_safe_s) && plan.dt_safe_s > 0),
      stats_ring_(sizeof(layout::TickStats) + sizeof(layout::AwakeList), kStatsInFlight, "the measurements of a tick") {
  if (plan.governed()) {
    recovery_.emplace(Recovery{
        GoodStates(buffers_.store.slot_count, kGoodStates + kLag), GuardPass(features_),
        plan.recovers_by_pd ? makeRecoveryStepper(kRecoveryIterations, features_, buffers_) : nullptr, std::nullopt});
    if (!plan.recovers_by_pd) recovery_->slow.emplace(features_);
    recovery_->good.save(buffers_);
  }
  if (plan.environment) environment_.emplace(model, scene, features_, buffers_);
  if (features_.obstacles > 0) obstacle_reaction_.emplace(features_, buffers_.store.active_count, true);
  for (const Body& body : model.bodies)
    largest_spacing_m_ = std::max(largest_spacing_m_, static_cast<float>(body.lattice.spacing_m));
  boxes_.reserve(layout::kMostToolBoxes);
  if (plan.tools) {
    const size_t rows = static_cast<size_t>(plan.mostSubsteps()) * layout::kMaxStyluses;
    tools_.emplace(Tools{gpu::Buffer<layout::ToolMotion>(rows, "tool motions"), GrabPass(features_), CutPass(features_),
                         ReactionPass(features_, buffers_.store.active_count)});
  }
  if (processesAct(scene, model, plan.tools) != ProcessActs::kNever) {
    blade_.reset(new Blade{NodeWindow(features_, buffers_.store.slot_count, awake_.get()),
                           gpu::Buffer<layout::ToolMotion>(layout::kMaxStyluses, "a sweep at rest"),
                           gpu::Buffer<layout::vec4>(buffers_.store.slot_count, "tissue at rest")});
    double friction_n_per_m = 0;
    for (const StylusConfig& stylus : scene.styluses)
      friction_n_per_m = std::max(friction_n_per_m, stylus.cut.friction_n_per_m);
    for (size_t b = 0; b < model.bodies.size(); ++b) {
      if (!resistsBlades(model.bodies[b])) continue;
      blade_->resists |= 1u << b;
      const double kernel_m = kernelOf(toughnesses(model.bodies[b]), friction_n_per_m);
      blade_->kernel_m = std::max(blade_->kernel_m, static_cast<float>(kernel_m));
    }
  }
  bind();
}

void GpuBackend::bind() const {
  buffers_.bind();
  if (awake_) awake_->bind();
}

void GpuBackend::beginTick() {
  rest_.beginTick();
  if (!rest_.resting()) bind();
}

/// Prepares the GPU for something that may wake the tissue.
void GpuBackend::disturb() {
  if (rest_.resting()) bind();
  rest_.disturb();
}

void GpuBackend::wakeAll() {
  disturb();
  if (awake_) awake_->wakeAll();
}

void GpuBackend::takeHold(uint32_t stylus, const Pose& pose, double radius_m) {
  disturb();
  const Vector3f tip = pose.position_m.cast<float>(), reach = Vector3f::Constant(static_cast<float>(radius_m));
  if (awake_) awake_->wakeNear({{tip - reach, tip + reach}});
  tools_->grab.takeHold(buffers_, stylus, pose, radius_m);
  if (awake_) awake_->wakeHeld();
}

/// Releases nodes. After a tick without motion no force can be above the limit, so a release by force is skipped. What
/// is still held shows in the measurements of this tick, so this is no disturbance of the next.
void GpuBackend::letGo(uint32_t stylus, const Release& release) {
  const bool in_any_case = release.above_n_s < 0;
  if (rest_.resting() && !in_any_case) return;
  if (in_any_case) disturb();
  tools_->grab.letGo(buffers_, stylus, release);
  if (awake_) awake_->wakeHeld();
}

/// Uploads the motions of a tick and wakes bricks within reach of the tools, as the CPU backend does.
void GpuBackend::writeMotions(const std::vector<layout::ToolMotion>& motions) {
  const bool rested = rest_.resting();
  const bool cuts =
      std::any_of(motions.begin(), motions.begin() + layout::kMaxStyluses,
                  [](const layout::ToolMotion& m) { return m.info.y & (layout::kToolCuts | layout::kToolErases); });
  const ToolBoxes reached = toolBoxes(motions, largest_spacing_m_);
  boxes_.assign(reached.begin(), reached.end());
  std::vector<ToolBox> disturbed = boxes_;
  if (blade_ && std::exchange(blade_->looked, false)) disturb();  // the fronts of blades may have moved
  const float beside_m = std::max(kFarthestCut * largest_spacing_m_, blade_ ? blade_->kernel_m : 0);
  for (ToolBox& box : disturbed) {
    const Vector3f more = Vector3f::Constant(cuts ? beside_m : 0);
    box = {box.low - more, box.high + more};
  }
  if (!rest_.disturbNear(disturbed) && rested) return;
  if (rested) bind();
  tools_->motions.write(motions);
  if (awake_) awake_->wakeNear(boxes_);
}

void GpuBackend::selectMotions(size_t substep) {
  substep_ = substep;
  if (rest_.resting()) return;
  tools_->motions.bindUniform(layout::kBindToolMotions, substep * layout::kMaxStyluses, layout::kMaxStyluses);
}

void GpuBackend::cut(uint32_t stylus, bool particles) {
  if (rest_.resting()) return;
  cutBut(blade_ && !particles ? blade_->resists : 0, stylus, particles);
}

/// Cuts bodies.
/// @param spared  bodies that are not cut, a bit each
void GpuBackend::cutBut(uint32_t spared, uint32_t stylus, bool particles) {
  const gpu::TimedStage timed(gpu::Stage::kCut);
  tools_->cut.run(buffers_, stylus, particles, spared);
  if (awake_) awake_->wakeCut(stylus);
}

void GpuBackend::readNodes(const std::vector<uint32_t>& slots, std::vector<Vector3f>& u_m,
                           std::vector<Vector3f>& v_m_per_s) const {
  const gpu::TimedStage timed(gpu::Stage::kCut);
  if (rest_.resting()) bind();  // suction also reads at rest
  blade_->looked = true;
  blade_->window.read(slots, u_m, v_m_per_s);
}

void GpuBackend::pushNodes(uint32_t stylus, float dt_s, const std::vector<uint32_t>& slots,
                           const std::vector<Vector3f>& dv_m_per_s) {
  const gpu::TimedStage timed(gpu::Stage::kCut);
  blade_->window.push(buffers_, stylus, dt_s, slots, dv_m_per_s);
}

/// Cuts tissue at its rest position. This may happen in a tick without blades, in which everything rests.
void GpuBackend::cutAtRest(const layout::ToolMotion& sweep, bool particles) {
  disturb();
  blade_->sweep.write(&sweep, 1);
  blade_->sweep.bindUniform(layout::kBindToolMotions);
  const uint32_t still = blade_->still.id();
  gpu::bindStorages(layout::kBindDisplacementIn, {still, still});
  cutBut(~(1u << blade_->body), 0, particles);
  buffers_.state.bind();
  selectMotions(substep_);
}

void GpuBackend::advance(const Substep& step, bool recovery) {
  if (recovery && step.restarted) wakeAll();
  if (rest_.resting()) {
    awake_->slept(step);
    return;
  }
  const gpu::TimedStage timed(gpu::Stage::kStep);
  const bool by_pd = recovery && recovery_->stepper;
  Stepper& stepper = by_pd ? *recovery_->stepper : *stepper_;
  if (environment_ && step.implicit) environment_->bindObstacles(step);
  stepper.run(buffers_, step);
  buffers_.swap();
  if (recovery && !by_pd) recovery_->slow->run(buffers_, step);
}

void GpuBackend::beginEnvironment(const Environment& environment) {
  environment_->beginTick(environment);
}

void GpuBackend::blow(const Substep& step, const Environment& environment) {
  const gpu::TimedStage timed(gpu::Stage::kStep);
  environment_->blow(buffers_, step, environment);
}

void GpuBackend::sumObstacles(const std::vector<Vector3f>& positions) {
  const gpu::TimedStage timed(gpu::Stage::kReaction);
  obstacle_reaction_->runObstacles(buffers_, positions);
}

void GpuBackend::surround(const Substep& step, const Environment& environment) {
  const gpu::TimedStage timed(gpu::Stage::kStep);
  environment_->run(buffers_, step, environment);
}

void GpuBackend::measure() {
  if (rest_.resting()) return;
  const gpu::TimedStage timed(gpu::Stage::kMeasure);
  measure_.run(buffers_);
  if (environment_) environment_->recordCrowded(buffers_.stats);
}

void GpuBackend::sumReactions(const std::array<Vector3f, layout::kMaxStyluses>& tips) {
  if (rest_.resting()) return;
  const gpu::TimedStage timed(gpu::Stage::kReaction);
  tools_->reaction.run(buffers_, tips);
}

void GpuBackend::guard(const StabilityMonitor::Bounds& bounds, const ToolMotions& motions, double tick_s) {
  if (rest_.resting()) return;
  const gpu::TimedStage timed(gpu::Stage::kMeasure);
  recovery_->good.bindLast();
  recovery_->guard.run(buffers_, bounds, motions, tick_s);
}

/// Requests the measurements at the end of a tick. OpenGL's errors are checked here, as a check after each call would
/// be slow.
bool GpuBackend::requestStats() {
  gpu::checkErrors("a tick of the solver");
  if (stats_ring_.inFlight() == kStatsInFlight) return false;
  if (awake_ && !rest_.resting()) awake_->list();
  const gpu::ReadbackRing::Source sources[] = {{buffers_.stats.id(), 0, sizeof(layout::TickStats)},
                                               {awake_ ? awake_->nodes().id() : 0, 0, sizeof(layout::AwakeList)}};
  return stats_ring_.request(sources, awake_ ? 2 : 1, rest_.send());
}

bool GpuBackend::takeStats(layout::TickStats& stats, bool wait) {
  uint64_t tick = 0;
  const void* memory = stats_ring_.collect(&tick, wait);
  if (!memory) return false;
  std::memcpy(&stats, memory, sizeof stats);
  if (awake_) {
    layout::AwakeList awake;
    std::memcpy(&awake, static_cast<const char*>(memory) + sizeof stats, sizeof awake);
    rest_.receive(tick, awake);
  }
  stats_ring_.release();
  if (has_springs_ && !foreign_) requireSignOfLife(stats);
  return true;
}

void requireSignOfLife(const layout::TickStats& stats) {
  if (stats.max_rate_bits != 0 || stats.springs_cut != 0 || stats.nonfinite != 0) return;
  throw GpuError(
      "the GPU does not step the tissue: its measurements are empty (out of memory, or the driver failed; last "
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
  readCuts(out);
  return out;
}

std::vector<uint8_t> GpuBackend::awake() const {
  if (!awake_) return std::vector<uint8_t>(bricks(), 1);
  bind();
  awake_->list();
  return awake_->awake();
}

void GpuBackend::readCuts(CutSprings& out) const {
  out.nodes = buffers_.store.nodes.read();
  out.spring_cut = buffers_.links.spring_cut.read();
  out.axial_cut = buffers_.readAxialCut(out.spring_cut);
}

void GpuBackend::resetState() {
  foreign_ = false;
  buffers_.reset();
  stepper_->restart();
  wakeAll();
  if (awake_) awake_->restart();
  if (environment_) environment_->restart();
  if (pairs_) pairs_->restart();
}

void GpuBackend::loadState(const HostState& state) {
  foreign_ = true;
  stepper_->restart();
  buffers_.state.displacement[buffers_.state.current].write(state.displacement_m);
  buffers_.state.velocity[buffers_.state.current].write(state.velocity_m_per_s);
  buffers_.store.nodes.write(state.nodes);
  buffers_.writeSpringCut(state.spring_cut);
  buffers_.writeAxialCut(state.axial_cut);
  if (buffers_.state.compensation.size()) buffers_.state.compensation.clear();
  if (environment_) environment_->restart();
  if (pairs_) pairs_->restart();
  wakeAll();
  bind();
}

void GpuBackend::saveGood() {
  const gpu::TimedStage timed(gpu::Stage::kMeasure);
  recovery_->good.save(buffers_, rest_.resting());
}

void GpuBackend::restoreGood(int back) {
  wakeAll();
  recovery_->good.restore(buffers_, back);
  buffers_.clearRolledBack();
  stepper_->restart();
  if (environment_) environment_->restart();
  if (pairs_) pairs_->restart();
}

/// RestWatch is not saved, as it changes no result. After loading, tissue is not assumed to be at rest.
void GpuBackend::persist(Archive& archive) {
  disturb();
  archive.section("integrator");
  stepper_->persist(archive);
  if (environment_) environment_->persist(archive);
  if (pairs_) pairs_->persist(archive);
  buffers_.persist(archive);
  archive.section("gpu");
  archive.value(foreign_);
  if (awake_) awake_->persist(archive);
  if (recovery_) recovery_->good.persist(archive);
  bind();
}

void GpuBackend::clearGood() {
  recovery_->good.clear();
}

}  // namespace viscera
