// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "bench/suites/blade/tear_trial.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "solver/cpu/cpu_solver.h"
#include "viscera/model/model.h"
#include "viscera/model/scene/scene.h"

namespace viscera::bench {

namespace {

constexpr double kSlit_m = 0.03;
constexpr double kTearTrialTick_hz = 100;
constexpr double kBeside = 0.31;                            // offset of the slit from rows of nodes [spacings]
constexpr double kTearTrialHeld = 0.4;                      // [spacings]
constexpr double kBlade_m = 0.05;                           // length
constexpr double kCrumb = 0.05;                             // share of the nodes
constexpr double kStripDrag = 200;                          // 1/s: suppresses oscillations after release
constexpr double kStripTime_s = 0.5;                        // time for the slit to grow
constexpr double kRuns = 0.6;                               // share of the remaining length
constexpr double kLinear = 16.0 / 15;                       // 1 / (1 - nu^2) of a clamped strip, nu 1/4: search start
constexpr double kLeast = 0.5, kMost = 2.5, kFound = 0.03;  // range of the search; its final relative width
constexpr double kLong_m = 0.096, kShort_m = 0.064;         // lengths of strips for the energy difference
constexpr double kSpeed_m_per_s = 0.05;                     // speed of each leg
constexpr double kLongest = 3;                              // displacement of a leg over the plate's length
constexpr double kGrip_m = 0.0055;                          // radius that does not reach the other leg
constexpr double kLegs_m = 0.024;                           // width of both legs
constexpr double kFrom_m = 0.006, kTo_m = 0.012;            // distances from the slit's end and from the plate's,
                                                            // between which forces count
constexpr double kMean_m = 0.004;                           // length of tear per mean

BodyConfig bodyOf(const TearTrial& trial) {
  BodyConfig body;
  body.source = TissueSource::kBox;
  body.box_size_m = {trial.length_m, trial.width_m, trial.thickness_m};
  body.spacing_m = trial.spacing_m;
  body.material.young_modulus_pa = trial.young_modulus_pa;
  body.material.poisson_ratio = trial.poisson_ratio;
  body.material.tear.toughness_j_per_m2 = trial.toughness_j_per_m2;
  return body;
}

/// Returns a scene in which the first stylus cuts and all can grip.
Scene sceneOf(const BodyConfig& body) {
  Scene scene;
  scene.bodies.push_back(body);
  for (int i = 0; i < 2; ++i) {
    StylusConfig stylus;
    stylus.idle = ToolMode::kCut;
    stylus.cut.blade_length_m = kBlade_m;
    stylus.grab.radius_m = kGrip_m;
    scene.styluses.push_back(stylus);
  }
  scene.environment.gravity_m_per_s2.setZero();
  scene.solver.tick_hz = kTearTrialTick_hz;
  scene.solver.backend = Backend::kCpu;
  scene.solver.integrator = Integrator::kLeapfrog;
  return scene;
}

/// A plate and its solver.
struct Plate {
  explicit Plate(const Scene& scene) : model(buildModel(scene)), solver(model, scene) {}

  void step(const ToolMotions& motions) {
    solver.step(motions);
    while (solver.pollStats(stats, true)) {
    }
  }
  /// Cuts the slit along x, from the plate's end, with a blade that meets no resistance.
  void slit(const TearTrial& trial) {
    ToolMotions motions;
    motions[0].mode = ToolMode::kCut;
    motions[0].present = true;
    motions[0].from.position_m = {-trial.length_m, kBeside * trial.spacing_m, -0.5 * kBlade_m};
    motions[0].to.position_m = motions[0].from.position_m;
    motions[0].to.position_m.x() = kSlit_m - 0.5 * trial.length_m;
    step(motions);
  }
  /// Returns the farthest x of a node that has lost a spring [m].
  double tip_m() const {
    double out = -1;
    const HostState state = solver.readState();
    for (const uint32_t slot : model.bodies[0].lattice.active_slots) {
      if (state.nodes[slot].lo & layout::kSeveredBit)
        out = std::max(out, model.bodies[0].lattice.restPosition(slot).x());
    }
    return out;
  }
  size_t crumbs() const;

  Model model;
  CpuSolver solver;
  layout::TickStats stats{};
};

/// Returns the number of pieces with few nodes, connected by springs.
size_t Plate::crumbs() const {
  const Lattice& lattice = model.bodies[0].lattice;
  const HostState state = solver.readState();
  std::vector<uint8_t> seen(state.nodes.size());
  std::vector<uint32_t> waiting;
  size_t out = 0;
  for (const uint32_t first : lattice.active_slots) {
    if (seen[first]) continue;
    size_t nodes = 0;
    seen[first] = 1;
    for (waiting.assign(1, first); !waiting.empty(); ++nodes) {
      const uint32_t slot = waiting.back();
      waiting.pop_back();
      for (uint32_t spring = 0; spring < layout::kSpringsPerNode; ++spring) {
        if (springCount(state.nodes[slot], spring) == 0) continue;
        const auto other = static_cast<uint32_t>(lattice.neighborSlot(slot, spring));
        if (!seen[other]) waiting.push_back(other);
        seen[other] = 1;
      }
    }
    out += static_cast<double>(nodes) < kCrumb * static_cast<double>(lattice.active_slots.size());
  }
  return out;
}

Scene stripOf(const TearTrial& trial) {
  BodyConfig body = bodyOf(trial);
  body.material.mass_damping_per_s = kStripDrag;
  const double inner = 0.5 * trial.width_m - kTearTrialHeld * trial.spacing_m;
  for (const double side : {1.0, -1.0}) {
    FixedConfig fixed;
    fixed.min_m = {-1, side > 0 ? inner : -1, -1};
    fixed.max_m = {1, side > 0 ? 1 : -inner, 1};
    body.fixed.push_back(fixed);
  }
  return sceneOf(body);
}

/// Stretches everything across the slit, including the fixed sides.
void strain(Plate& plate, double strain) {
  HostState state = plate.solver.readState();
  for (const uint32_t slot : plate.model.bodies[0].lattice.active_slots) {
    const double y_m = plate.model.bodies[0].lattice.restPosition(slot).y();
    state.displacement_m[slot] = {0, static_cast<float>(strain * y_m), 0, 0};
    state.velocity_m_per_s[slot] = {0, 0, 0, 0};
  }
  plate.solver.writeState(state);
}

bool runs(const TearTrial& trial, double at_strain, size_t& crumbs) {
  Plate plate(stripOf(trial));
  plate.slit(trial);
  strain(plate, at_strain);
  for (int i = 0; i < kStripTime_s * kTearTrialTick_hz; ++i) plate.step({});
  crumbs = plate.crumbs();
  return plate.tip_m() + 0.5 * trial.length_m > kSlit_m + kRuns * (trial.length_m - kSlit_m);
}

/// Returns the elastic energy of a strip without slit or tearing, at a strain, per length and thickness [J/m2].
double storedPerArea(TearTrial trial, double at_strain) {
  trial.toughness_j_per_m2 = 0;
  double energy_j[2];
  for (const bool is_long : {false, true}) {
    trial.length_m = is_long ? kLong_m : kShort_m;
    Plate plate(stripOf(trial));
    strain(plate, at_strain);
    for (int i = 0; i < kStripTime_s * kTearTrialTick_hz; ++i) plate.step({});
    energy_j[is_long] = static_cast<double>(plate.stats.elastic_j);
  }
  return (energy_j[1] - energy_j[0]) / ((kLong_m - kShort_m) * trial.thickness_m);
}

/// Returns the force in every tick while the tear grows, over half of toughness times thickness.
std::vector<double> legForces(const TearTrial& trial, Plate& plate) {
  ToolMotions motions;
  for (const size_t s : {0, 1}) {
    motions[s].mode = ToolMode::kGrab;
    motions[s].present = motions[s].hold_begins = true;
    motions[s].to.position_m = {-0.5 * trial.length_m, (s ? 0.25 : -0.25) * trial.width_m, 0};
  }
  const double step_m = kSpeed_m_per_s / kTearTrialTick_hz, law_n = 0.5 * trial.toughness_j_per_m2 * trial.thickness_m;
  std::vector<double> out;
  for (double offset_m = 0; offset_m < kLongest * trial.length_m; offset_m += step_m) {
    for (const size_t s : {0, 1}) {
      motions[s].from = motions[s].to;
      motions[s].to.position_m.z() += s ? step_m : -step_m;
    }
    plate.step(motions);
    for (const size_t s : {0, 1}) motions[s].hold_begins = false;
    const double tip_m = plate.tip_m() + 0.5 * trial.length_m;
    if (tip_m >= trial.length_m - kTo_m) break;
    const double impulse_n_s = static_cast<double>(plate.stats.impulse[0].z - plate.stats.impulse[1].z);
    if (tip_m > kSlit_m + kFrom_m) out.push_back(0.5 * std::abs(impulse_n_s) * kTearTrialTick_hz / law_n);
  }
  return out;
}

double meanOf(const std::vector<double>& values, size_t first, size_t end) {
  double sum = 0;
  for (size_t i = first; i < end; ++i) sum += values[i];
  return sum / static_cast<double>(end - first);
}

}  // namespace

StripResult pullStrip(const TearTrial& trial) {
  StripResult out;
  const double per_release = 2 * trial.toughness_j_per_m2 / (kLinear * trial.young_modulus_pa * trial.width_m);
  double low = kLeast, high = kMost;
  while (high - low > kFound * low) {
    const double middle = 0.5 * (low + high);
    size_t crumbs = 0;
    const bool goes_on = runs(trial, std::sqrt(middle * per_release), crumbs);
    (goes_on ? high : low) = middle;
    if (goes_on) out.crumbs = crumbs;
  }
  out.strain = std::sqrt(0.5 * (low + high) * per_release);
  out.release = storedPerArea(trial, out.strain) / trial.toughness_j_per_m2;
  return out;
}

TrouserResult pullTrousers(const TearTrial& asked) {
  TearTrial trial = asked;
  trial.width_m = kLegs_m;
  Plate plate(sceneOf(bodyOf(trial)));
  plate.slit(trial);
  const std::vector<double> forces = legForces(trial, plate);
  TrouserResult out;
  const auto per_mean = static_cast<size_t>(kMean_m / kSpeed_m_per_s * kTearTrialTick_hz);
  out.least = kMost;
  for (size_t i = 0; i + per_mean <= forces.size(); i += per_mean) {
    const double mean = meanOf(forces, i, i + per_mean);
    out.least = std::min(out.least, mean);
    out.most = std::max(out.most, mean);
  }
  out.force = meanOf(forces, 0, forces.size());
  out.trips = static_cast<double>(plate.solver.health().trips);
  out.crumbs = plate.crumbs();
  return out;
}

}  // namespace viscera::bench
