// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "bench/suites/blade/blade_trial.h"

#include <Eigen/Geometry>
#include <Eigen/LU>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <memory>
#include <optional>

#include "bench/harness/specimens/backends.h"
#include "math/float_bits.h"
#include "model/fracture/toughness.h"
#include "solver/processes/blade/blades.h"
#include "solver/reference/reference_lattice.h"
#include "viscera/model/model.h"
#include "viscera/model/scene/scene.h"

namespace viscera::bench {

namespace {

constexpr double kDegree = 3.14159265358979323846 / 180;
constexpr double kSteadyFrom = 0.7;   // relative to the stroke
constexpr double kTickTravel = 0.25;  // relative to the spacing: ticks are short enough to resolve a cell
constexpr double kLeastTick_hz = 60;
constexpr double kHeld = 0.49;                // in spacings: rows of a sheet may end before its border
constexpr double kBladeTrialClear_m = 0.001;  // distance before the block [m]
constexpr double kOver_m = 0.003;             // length of the blade above and below it [m]

Vector3d xyz(const layout::vec4& v) {
  return {v.x, v.y, v.z};
}

/// Returns a block that is fixed on all sides except that where the blade enters; free above and below.
Scene sceneOf(const BladeTrial& trial) {
  Scene scene;
  BodyConfig body;
  body.structure = trial.structure;
  body.source = trial.structure == Structure::kSurface ? TissueSource::kSheet : TissueSource::kBox;
  body.thickness_m = trial.thickness_m;
  body.box_size_m = {trial.length_m, trial.width_m, trial.thickness_m};
  body.spacing_m = trial.spacing_m;
  body.material.young_modulus_pa = trial.young_modulus_pa;
  if (trial.structure == Structure::kLattice) body.material.law = trial.law;
  body.material.cut.toughness_j_per_m2 = trial.toughness_j_per_m2;
  const Vector3d half = 0.5 * body.box_size_m, thin = Vector3d::Constant(kHeld * trial.spacing_m);
  for (const Vector3d& side : {Vector3d(0, 1, 0), Vector3d(0, -1, 0), Vector3d(1, 0, 0)}) {
    FixedConfig fixed;
    const Vector3d all = half + thin;
    fixed.min_m = (side.array() > 0).select(half - thin, -all);
    fixed.max_m = (side.array() < 0).select(-half + thin, all);
    body.fixed.push_back(fixed);
  }
  scene.bodies.push_back(body);
  StylusConfig stylus;
  stylus.idle = ToolMode::kCut;
  stylus.cut.blade_length_m = trial.thickness_m + 2 * kOver_m + 2 * trial.slicing * trial.stroke_m;
  scene.styluses.push_back(stylus);
  scene.environment.gravity_m_per_s2.setZero();
  scene.solver.tick_hz = std::max(kLeastTick_hz, trial.speed_m_per_s / (kTickTravel * trial.spacing_m));
  scene.solver.backend = trial.backend;
  scene.solver.sleep_speed_m_per_s = 0;
  return scene;
}

/// Returns the smallest area of a triangle without a cut spring, relative to rest.
double leastVolume(const SpringNetwork& network, const HostState& state) {
  double least = 1;
  for (const std::array<uint32_t, 3>& slots : network.triangles) {
    const auto is_severed = [&](uint32_t slot) { return (state.nodes[slot].lo & layout::kSeveredBit) != 0; };
    if (std::any_of(slots.begin(), slots.end(), is_severed)) continue;
    Eigen::Matrix3d rest = Eigen::Matrix3d::Identity(), now = rest;
    for (size_t i = 1; i < slots.size(); ++i) {
      const auto column = static_cast<int>(i) - 1;
      rest.col(column) = network.positions_m[slots[i]] - network.positions_m[slots[0]];
      now.col(column) = rest.col(column) + xyz(state.displacement_m[slots[i]]) - xyz(state.displacement_m[slots[0]]);
    }
    now.col(2) = rest.col(2) = rest.col(0).cross(rest.col(1)).normalized();
    least = std::min(least, now.determinant() / rest.determinant());
  }
  return least;
}

/// Returns the smallest volume of a whole cell, relative to rest.
double leastVolume(const Model& model, const HostState& state) {
  const std::optional<SpringNetwork>& network = model.bodies[0].network;
  if (network && !network->of_lattice) return leastVolume(*network, state);
  const Lattice& lattice = model.bodies[0].lattice;
  double least = 1;
  for (const uint32_t slot : lattice.active_slots) {
    if (!(state.nodes[slot].lo & layout::kCellBit)) continue;
    Eigen::Matrix3d edges = Eigen::Matrix3d::Identity();
    bool whole = true;
    forEachCorner(lattice, slot, [&](const Vector3i& corner, uint32_t at) {
      whole &= (state.nodes[at].lo & layout::kSeveredBit) == 0;
      const Vector3d u = xyz(state.displacement_m[at]) / lattice.spacing_m;
      for (int a = 0; a < 3; ++a) edges.col(a) += (corner[a] ? 0.25 : -0.25) * u;
    });
    if (whole) least = std::min(least, edges.determinant());
  }
  return least;
}

/// One stroke of the blade, tick by tick.
class Stroke {
 public:
  explicit Stroke(const BladeTrial& trial)
      : trial_(trial),
        scene_(sceneOf(trial)),
        model_(buildModel(scene_)),
        solver_(solverOn(trial.backend, model_, scene_)) {
    const double angle = trial.angle_deg * kDegree;
    go_ = {std::cos(angle), std::sin(angle), 0};
    direction_ = go_ - trial.slicing * Vector3d::UnitZ();
    at_ = {-0.5 * trial.length_m - kBladeTrialClear_m,
           -0.5 * trial.stroke_m * std::sin(angle) + trial.beside * trial.spacing_m,
           -0.5 * trial.thickness_m - kOver_m};
    if (trial.damped) lattice_.emplace(model_);
    force_unit_n_ = toughnessOf(model_.bodies[0]).carried_j_per_m2() * trial.thickness_m;
  }

  BladeResult run() {
    const double tick_s = 1 / scene_.solver.tick_hz;
    const auto ticks = static_cast<long>(trial_.stroke_m / trial_.speed_m_per_s / tick_s);
    for (long k = 0; k < ticks; ++k) tick(tick_s);
    finish();
    return out_;
  }

 private:
  using Clock = std::chrono::steady_clock;

  void tick(double tick_s) {
    ToolMotions motions;
    motions[0].mode = trial_.there ? ToolMode::kCut : ToolMode::kNone;
    motions[0].present = trial_.there;
    motions[0].from.position_m = at_;
    at_ += tick_s * trial_.speed_m_per_s * direction_;
    motions[0].to.position_m = at_;
    gone_m_ += tick_s * trial_.speed_m_per_s;
    const Clock::time_point start = Clock::now();
    solver_->step(motions);
    layout::TickStats stats;
    while (solver_->pollStats(stats, true)) last_ = stats;
    const double took_us = std::chrono::duration<double, std::micro>(Clock::now() - start).count();
    const Vector3d force_n = xyz(last_.impulse[0]) / tick_s;
    out_.stretch = std::max(out_.stretch, static_cast<double>(floatFromBits(last_.max_stretch_bits)));
    if (lattice_) damped_j_ += tick_s * damping_w();
    if (out_.onset_m == 0 && bladeWork(*solver_, 0).area_m2 > trial_.spacing_m * trial_.thickness_m)
      out_.onset_m = gone_m_ - kBladeTrialClear_m;
    if (gone_m_ < kSteadyFrom * trial_.stroke_m) return;
    if (steady_.size() % 8 == 0) out_.worst_det = std::min(out_.worst_det, leastVolume(model_, solver_->readState()));
    steady_.push_back(force_n.dot(go_) / force_unit_n_);
    out_.along -= force_n.z() / force_unit_n_;
    busy_us_.push_back(took_us / solver_->substeps());
  }

  /// Returns the current power of drag and dashpots.
  double damping_w() {
    const HostState state = solver_->readState();
    lattice_->nodes = state.nodes;
    lattice_->spring_cut = state.spring_cut;
    Field u_m, v_m_per_s;
    for (const layout::vec4& u : state.displacement_m) u_m.push_back(xyz(u));
    for (const layout::vec4& v : state.velocity_m_per_s) v_m_per_s.push_back(xyz(v));
    const double drag_w = 2 * scene_.bodies[0].material.mass_damping_per_s * static_cast<double>(last_.kinetic_j);
    return drag_w + 2 * lattice_->dissipation(u_m, v_m_per_s);
  }

  void finish() {
    double sum = 0;
    for (const double force : steady_) sum += force;
    const auto count = static_cast<double>(steady_.size());
    const auto [low, high] = std::minmax_element(steady_.begin(), steady_.end());
    out_.force = sum / count;
    out_.ripple = (*high - *low) / out_.force;
    out_.along /= count;
    const Toughness toughness = toughnessOf(model_.bodies[0]);
    out_.length_m = toughness.spacing_m;
    out_.asked = out_.force * toughness.carried_j_per_m2() / trial_.toughness_j_per_m2;
    const BladeWork work = bladeWork(*solver_, 0);
    out_.area_m2 = work.area_m2;
    out_.work_j = work.work_j;
    out_.cut_share = work.parting_j / work.work_j;
    out_.stored_share = (static_cast<double>(last_.elastic_j) + static_cast<double>(last_.kinetic_j)) / work.work_j;
    out_.damped_share = damped_j_ / work.work_j;
    out_.nodes = model_.activeNodes();
    out_.trips = static_cast<double>(solver_->health().trips);
    out_.fastest_us = *std::min_element(busy_us_.begin(), busy_us_.end());
    std::nth_element(busy_us_.begin(), busy_us_.begin() + static_cast<std::ptrdiff_t>(busy_us_.size() / 2),
                     busy_us_.end());
    out_.substep_us = busy_us_[busy_us_.size() / 2];
  }

  BladeTrial trial_;
  Scene scene_;
  Model model_;
  std::unique_ptr<TissueStepper> solver_;
  Vector3d go_, direction_, at_;
  std::optional<ReferenceLattice> lattice_;  ///< used for the power of damping
  double damped_j_ = 0, gone_m_ = 0, force_unit_n_ = 0;
  layout::TickStats last_{};
  std::vector<double> steady_, busy_us_;
  BladeResult out_;
};

}  // namespace

BladeResult cutThrough(const BladeTrial& trial) {
  return Stroke(trial).run();
}

}  // namespace viscera::bench
