// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "solver/cpu/cpu_backend.h"

#include <algorithm>
#include <cmath>

#include "gpu/buffer.h"
#include "math/archive.h"
#include "math/float_bits.h"
#include "model/fracture/toughness.h"
#include "solver/contact/tool_boxes.h"
#include "solver/cpu/kernels/node_pairs.h"
#include "solver/cpu/state/lattice_arrays.h"
#include "solver/cpu/steps/network.h"
#include "solver/tissue/slowing.h"
#include "viscera/math/error.h"
#include "viscera/model/scene/scene.h"
#include "viscera/solver/material.h"

namespace viscera {

namespace {

constexpr Portions kMeasuredBricks{2, 16};

}  // namespace

simd::Kernels kernelsOrThrow(const std::string& target) {
  const std::optional<simd::Kernels> kernels = simd::kernelsFor(target);
  if (kernels) return *kernels;
  if (simd::targets().empty())
    throw SceneError(
        "the CPU kernels of this build do not run on this processor; build with VISCERA_KERNEL_TARGETS=all");
  std::string known;
  for (const std::string& name : simd::targets()) known += (known.empty() ? "" : ", ") + name;
  throw SceneError("unknown instruction set '" + target + "' on this processor: " + known);
}

struct CpuBackend::Work {
  std::vector<simd::BrickStats> stats;  ///< [bricks]
  std::vector<uint32_t> changed;        ///< bricks to measure
};

std::vector<std::string> simdTargets() {
  return simd::targets();
}

CpuBackend::CpuBackend(const Model& model, const Scene& scene, const TickPlan& plan, const CpuSolverOptions& options)
    : config_(scene.solver),
      kernels_(kernelsOrThrow(options.simd)),
      features_(featuresOf(model, scene, plan.shortestSubstep_s())),
      params_(bodyParams(model, plan.dt_safe_s)),
      lattice_(model, params_, features_),
      threads_(options.threads ? options.threads : makeThreadPool(scene.solver.threads)),
      pool_(*threads_),
      sleep_(lattice_, traitsOf(scene.solver.integrator).lets_bricks_sleep && !plan.staysAwake()
                           ? scene.solver.sleep_speed_m_per_s
                           : 0),
      work_(std::make_unique<Work>()),
      good_(plan.governed() ? kGoodStates : 0) {
  if (features_.network) network_ = std::make_unique<CpuNetwork>(lattice_, pool_, features_, kernels_);
  if (plan.environment) environment_.emplace(model, scene, lattice_, pool_);
  if (solvesContacts(scene)) pairs_ = std::make_unique<CpuNodePairs>(model, scene, lattice_, pool_);
  stepper_ = makeCpuStepper(config_.integrator, config_.iterations, lattice_,
                            {pool_, sleep_, network_.get(), features_, kernels_, pairs_.get()});
  work_->stats.resize(bricks());
  work_->changed.reserve(bricks());
  if (resistsBlades(scene)) {
    for (const Body& body : model.bodies) resists_.push_back(resistsBlades(body));
  }
  if (plan.tools) {
    cut_.emplace(lattice_, pool_, kernels_);
    motions_.reserve(static_cast<size_t>(plan.mostSubsteps()) * layout::kMaxStyluses);
  }
  if (features_.tears) tearing_.emplace(model);
  if (!plan.governed()) return;
  if (plan.recovers_by_pd) recovery_ = makeCpuRecoveryStepper(kRecoveryIterations, lattice_, pool_);
  saveGood();
}

CpuBackend::~CpuBackend() = default;

std::string CpuBackend::name() const {
  return "cpu (" + kernels_.target + ", " + std::to_string(pool_.threads()) +
         (pool_.threads() == 1 ? " thread)" : " threads)");
}

size_t CpuBackend::awakeBricks() const {
  return sleep_.awake().size();
}

std::vector<uint8_t> CpuBackend::awake() const {
  std::vector<uint8_t> out(bricks());
  for (const uint32_t brick : sleep_.awake()) out[brick] = 1;
  return out;
}

// ---- a tick ----

void CpuBackend::beginTick() {
  if (tearing_) tearing_->beginTick(lattice_, work_->stats);
}

void CpuBackend::takeHold(uint32_t stylus, const Pose& pose, double radius_m) {
  const Vector3f tip = pose.position_m.cast<float>(), reach = Vector3f::Constant(static_cast<float>(radius_m));
  sleep_.wakeNear(lattice_, tip - reach, tip + reach);
  viscera::takeHold(lattice_, stylus, pose, radius_m);
  recordHeld();
}

void CpuBackend::letGo(uint32_t stylus, const Release& release) {
  viscera::letGo(lattice_, stylus, release, stats_);
  recordHeld();
}

/// Marks and wakes the bricks with held nodes; their nodes are processed one by one.
void CpuBackend::recordHeld() {
  std::fill(lattice_.tools.held.begin(), lattice_.tools.held.end(), uint8_t{0});
  stats_.grabbed[0] = stats_.grabbed[1] = 0;
  for (uint32_t slot : lattice_.store.active) {
    const uint32_t by = (lattice_.store.nodes[slot].lo & layout::kGrabMask) >> layout::kGrabShift;
    if (by == 0) continue;
    ++stats_.grabbed[by - 1];
    if (lattice_.tools.held.empty()) continue;
    lattice_.tools.held[slot / layout::kBrickSlots] = 1;
    sleep_.wake(slot / layout::kBrickSlots);
  }
}

void CpuBackend::writeMotions(const std::vector<layout::ToolMotion>& motions) {
  motions_ = motions;
  wakeForTools(motions);
}

/// Wakes bricks within reach of the tools in this tick.
void CpuBackend::wakeForTools(const std::vector<layout::ToolMotion>& motions) {
  float spacing_m = 0;
  for (const layout::BodyParams& body : lattice_.store.bodies) spacing_m = std::max(spacing_m, body.origin_spacing.w);
  for (const ToolBox& box : toolBoxes(motions, spacing_m)) sleep_.wakeNear(lattice_, box.low, box.high);
}

void CpuBackend::selectMotions(size_t substep) {
  motion_ = &motions_[substep * layout::kMaxStyluses];
}

void CpuBackend::cut(uint32_t stylus, bool particles) {
  cutWith(motion_[stylus], particles, particles || resists_.empty() ? nullptr : resists_.data(), false);
}

/// Cuts with a state without displacements in place of the current one.
void CpuBackend::cutAtRest(const layout::ToolMotion& sweep, bool particles) {
  const auto exchange = [this] {
    lattice_.state.displacement[lattice_.state.current].swap(still_[0]);
    lattice_.state.velocity[lattice_.state.current].swap(still_[1]);
  };
  for (AlignedVector<float>& still : still_) still.resize(3 * lattice_.slotCount());
  others_.assign(lattice_.store.bodies.size(), 1);
  others_[selected_body_] = 0;
  exchange();
  cutWith(sweep, particles, others_.data(), true);
  exchange();
}

/// Cuts springs.
/// @param spared, at_rest  as for CpuCut::run()
void CpuBackend::cutWith(const layout::ToolMotion& motion, bool particles, const uint8_t* spared, bool at_rest) {
  uint32_t springs = cut_->run(lattice_, motion, particles, spared, at_rest);
  if (network_) springs += network_->cut(lattice_, motion, particles, spared);
  cut_->tearCells(lattice_);
  springs_cut_ += springs;
  if (springs == 0) return;
  for (uint32_t brick : cut_->bricks()) sleep_.wake(brick);
}

void CpuBackend::advance(const Substep& step, bool recovery) {
  if (recovery && step.restarted) sleep_.wakeAll(lattice_);
  (recovery && recovery_ ? *recovery_ : *stepper_).run(lattice_, step, motion_);
  lattice_.swap();
  if (recovery && !recovery_) slow(step);
  if (tearing_ && !recovery) tear();
}

/// Slows nodes after a substep of a recovery without pd (slowing.h). Sleeping bricks have no velocity.
void CpuBackend::slow(const Substep& step) {
  CpuState& state = lattice_.state;
  float* const u = state.displacement[state.current].data();
  float* const v = state.velocity[state.current].data();
  pool_(sleep_.awake().size(), [&](size_t i) {
    const uint32_t brick = sleep_.awake()[i], first = lattice_.store.first_active[brick];
    const layout::BodyParams& body = lattice_.store.bodies[lattice_.store.bricks[brick].body];
    const float most = step.most_step * body.origin_spacing.w / step.dt_s;
    for (uint32_t n = first; n < lattice_.store.first_active[brick + 1]; ++n) {
      const uint32_t slot = lattice_.store.active[n];
      const Vector3f speed = planesAt(v, slot);
      const float share = speed.norm() > most ? most / speed.norm() : 1;
      setPlanes(u, slot, planesAt(u, slot) - (1 - share) * step.dt_s * speed);
      setPlanes(v, slot, kSlowingKeeps * share * speed);
    }
  });
}

void CpuBackend::tear() {
  const uint32_t springs = tearing_->run(lattice_);
  if (springs == 0) return;
  springs_cut_ += springs;
  torn_ = true;
  for (const uint32_t brick : tearing_->bricks()) sleep_.wake(brick);
}

void CpuBackend::blow(const Substep& step, const Environment& environment) {
  environment_->blow(lattice_, step, environment);
}

void CpuBackend::surround(const Substep& step, const Environment& environment) {
  environment_->run(lattice_, step, environment);
}

/// Adds cells in thin walls to the measurements of bricks.
void CpuBackend::measureWalls(const std::vector<uint32_t>& bricks) {
  CpuWalls& walls = lattice_.strengths.walls;
  const std::vector<uint32_t> groups = walls.acting(bricks), seen = walls.seen(groups);
  const float* displacement = lattice_.state.displacement[lattice_.state.current].data();
  pool_(seen.size(), [&](size_t i) {
    const layout::BodyParams& body = lattice_.store.bodies[lattice_.store.bricks[seen[i]].body];
    walls.place(seen[i], body, displacement, nullptr, 0);
  });
  const simd::WallJob job{lattice_.store.bodies.data(), walls.groups()};
  pool_.ranges(groups.size(), kMeasuredBricks,
               [&](size_t first, size_t end) { kernels_.measure_walls(job, &groups[first], end - first); });
  for (const uint32_t brick : bricks) {
    const auto [elastic_j, stiffening] = walls.measured(brick);
    simd::BrickStats& stats = work_->stats[brick];
    if (std::isfinite(elastic_j)) stats.elastic_j += static_cast<double>(elastic_j);
    stats.max_stiffening = std::max(stats.max_stiffening, std::min(stiffening, layout::kMostStiffening));
  }
}

void CpuBackend::measure() {
  simd::MeasureJob job{arraysOf(lattice_), cellsOf(lattice_), lattice_.store.nodes.data(),
                       lattice_.strengths.mass.data(), work_->stats.data()};
  std::vector<uint32_t>& changed = work_->changed;
  sleep_.takeChanged(lattice_, changed);
  pool_.ranges(changed.size(), kMeasuredBricks,
               [&](size_t first, size_t end) { kernels_.measure(job, &changed[first], end - first); });
  if (!lattice_.strengths.walls.empty()) measureWalls(changed);
  layout::TickStats out{};
  out.springs_cut = springs_cut_;
  std::copy(std::begin(stats_.grabbed), std::end(stats_.grabbed), std::begin(out.grabbed));
  double kinetic_j = 0, elastic_j = 0;
  float stretch = 0, speed = 0, stiffening = 0;
  for (const simd::BrickStats& brick : work_->stats) {
    kinetic_j += brick.kinetic_j;
    elastic_j += brick.elastic_j;
    stretch = std::max(stretch, brick.max_stretch);
    speed = std::max(speed, brick.max_speed);
    stiffening = std::max(stiffening, brick.max_stiffening);
    out.nonfinite += brick.nonfinite;
    out.collapsed += brick.collapsed;
    out.inverted += brick.inverted;
  }
  out.kinetic_j = static_cast<float>(kinetic_j);
  out.elastic_j = static_cast<float>(elastic_j);
  out.max_stretch_bits = bitsOfFloat(stretch);
  out.max_speed_bits = bitsOfFloat(speed);
  out.max_stiffening_bits = bitsOfFloat(stiffening);
  if (environment_) out.crowded = environment_->crowded();
  const bool known = !network_ && stats_.max_rate_bits != 0 && springs_cut_ == rate_springs_cut_;
  out.max_rate_bits = known ? stats_.max_rate_bits : bitsOfFloat(largestRate());
  rate_springs_cut_ = springs_cut_;
  if (network_) network_->measure(lattice_, out);
  stats_ = out;
}

/// Returns the largest (2 sum k + 1.5/h^2 sum of bulks) / m of a node that is not fixed [1/s2] (physics.md 2;
/// shaders/solver/step/measure.comp).
float CpuBackend::largestRate() const {
  float largest = 0;
  for (uint32_t slot : lattice_.store.active) {
    const layout::NodeBits& bits = lattice_.store.nodes[slot];
    if ((bits.lo & layout::kFixedBit) || lattice_.connections(slot) != layout::kImplicit) continue;
    float springs = 0;
    for (size_t s = 0; s < layout::kSpringsPerNode; ++s)
      springs += lattice_.strengths.both_ends[simd::springAt(slot, s)];
    const float bulk = lattice_.strengths.bulkAround(lattice_.store, slot);
    const float h = lattice_.store.bodies[bits.hi >> layout::kBodyShift].origin_spacing.w;
    largest = std::max(largest, (2 * springs + 1.5f * bulk / (h * h)) / lattice_.strengths.mass[slot]);
  }
  return largest;
}

void CpuBackend::sumReactions(const std::array<Vector3f, layout::kMaxStyluses>& tips) {
  sumPushes();
  viscera::sumReactions(lattice_, tips, stats_);
}

void CpuBackend::sumObstacles(const std::vector<Vector3f>& positions) {
  viscera::sumObstacles(lattice_, positions, stats_);
}

bool CpuBackend::requestStats() {
  if (has_stats_) return false;
  has_stats_ = true;
  return true;
}

bool CpuBackend::takeStats(layout::TickStats& stats, bool) {
  if (!has_stats_) return false;
  stats = stats_;
  has_stats_ = false;
  return true;
}

// ---- state as a whole ----

/// Updates everything after an external write to the state: both states become equal, without velocity where nothing
/// moves, and all bricks awake and measured again.
void CpuBackend::changeAll() {
  AlignedVector<float>& velocity = lattice_.state.velocity[lattice_.state.current];
  for (uint32_t slot : lattice_.store.active) {
    if (lattice_.strengths.mobility[slot] == 0) setPlanes(velocity.data(), slot, Vector3f::Zero());
  }
  lattice_.state.displacement[1 - lattice_.state.current] = lattice_.state.displacement[lattice_.state.current];
  lattice_.state.velocity[1 - lattice_.state.current] = lattice_.state.velocity[lattice_.state.current];
  stepper_->restart();
  if (network_) network_->restart(lattice_);
  if (environment_) environment_->restart();
  if (pairs_) pairs_->restart();
  lattice_.visitState([](const StateField& field, auto& values) {
    if (field.roll_back == FieldRollBack::kClear) setToRest(field, values);
  });
  for (AlignedVector<float>& pushed : pushed_) std::fill(pushed.begin(), pushed.end(), 0.0f);
  sleep_.wakeAll(lattice_);
}

void CpuBackend::resetState() {
  lattice_.reset();
  stats_ = {};
  has_stats_ = false;
  springs_cut_ = 0;
  sleep_.restart();
  changeAll();
  if (!lattice_.tools.held.empty()) recordHeld();
}

void CpuBackend::loadState(const HostState& state) {
  lattice_.write(state);
  stats_.max_rate_bits = 0;
  changeAll();
  recordHeld();
}

void CpuBackend::saveGood() {
  good_.save(lattice_);
}

void CpuBackend::restoreGood(int back) {
  good_.restore(lattice_, back);
  changeAll();
}

void CpuBackend::clearGood() {
  good_.clear();
}

void CpuBackend::persist(Archive& archive) {
  archive.section("integrator");
  stepper_->persist(archive, lattice_);
  if (environment_) environment_->persist(archive);
  if (pairs_) pairs_->persist(archive);
  lattice_.persist(archive);
  if (network_ && archive.reads()) network_->restart(lattice_);
  archive.section("cpu");
  sleep_.persist(archive);
  archive.values(work_->stats);
  archive.value(stats_);
  archive.value(springs_cut_);
  archive.value(rate_springs_cut_);
  good_.persist(archive, lattice_);
}

HostState CpuBackend::readState() const {
  return lattice_.read();
}

void CpuBackend::snapshot(StateSnapshot& out, uint64_t cut_revision) const {
  copyShown(lattice_.state.displacement[lattice_.state.current].data(), out);
  if (out.nodes.empty() || out.cut_revision != cut_revision) lattice_.readCuts(out);
  out.cut_revision = cut_revision;
}

}  // namespace viscera
