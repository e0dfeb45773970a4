// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "solver/cpu/equilibrium.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>

#include "math/number_text.h"
#include "math/union_find.h"
#include "model/body/body_nodes.h"
#include "solver/contact/environment.h"
#include "solver/cpu/cpu_backend.h"
#include "solver/cpu/steps/network.h"
#include "solver/processes/burn/heat_graph.h"
#include "solver/ticks/stable_step.h"
#include "viscera/math/error.h"
#include "viscera/model/scene/scene.h"
#include "viscera/solver/material.h"

namespace viscera {

namespace {

/// Substep over the longest stable one of tissue at rest: over the proven bound, and over the measured one for
/// lattices. Strained tissue has faster motions (docs/verification.md); a relaxation that diverges is restarted.
constexpr double kOfSafe = 0.75, kOfMeasured = 0.68;
constexpr double kShorter = 0.6;  ///< substep of the next attempt over that of the last
constexpr int kAttempts = 5;
constexpr double kDiverged = 1e3;  ///< residual over the load
constexpr int kMostSubsteps = 100000;
constexpr int kWindow = 32;   ///< substeps over which the slowest motion is measured
constexpr size_t kRates = 8;  ///< windows in which the slowest motion shows at least once
/// Consecutive substeps that must be settled, since oscillations are slow at their turning points.
constexpr int kCalm = 8;
/// `left` where rounding leaves more than kSettled of the forces.
constexpr double kLeftAtMost = kLeft / 3;
/// Motion that float32 does not resolve, over the spacing.
constexpr double kUnresolved = 1e-7;

double secondsSince(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// Requires that all tissue is held.
/// @throws SceneError  a piece of tissue has no fixed node and would fall; names its body and position
void requireHeld(const Model& model) {
  UnionFind pieces(model.slots());  // pieces of tissue connected by springs
  for (const BurntSpring& spring : springsOf(model)) pieces.unite(spring.a, spring.b);
  std::vector<uint8_t> is_held(model.slots(), 0);
  std::vector<uint32_t> sizes(model.slots(), 0);
  for (size_t b = 0; b < model.bodies.size(); ++b) {
    for (const uint32_t local : model.bodies[b].lattice.active_slots) {
      const uint32_t root = pieces.find(model.slotOffset(b) + local);
      ++sizes[root];
      is_held[root] |= static_cast<uint8_t>(isFixed(model.bodies[b].lattice.nodes[local]));
    }
  }
  for (size_t b = 0; b < model.bodies.size(); ++b) {
    const Body& body = model.bodies[b];
    for (const uint32_t local : body.lattice.active_slots) {
      const uint32_t root = pieces.find(model.slotOffset(b) + local);
      if (is_held[root] || sizes[root] == 1) continue;  // nodes without springs do not fall
      const Vector3d at_m = restPosition(body, local);
      throw SceneError("body '" + body.name + "': a piece of " + std::to_string(sizes[root]) + " nodes at " +
                       numberText(at_m.x(), 3) + " " + numberText(at_m.y(), 3) + " " + numberText(at_m.z(), 3) +
                       " m is not held anywhere, so it has no equilibrium. Give it 'fixed' nodes");
    }
  }
}

/// Returns the scene with only its tissue and its load.
Scene tissueOf(const Scene& scene) {
  Scene out = scene;
  out.styluses.clear();
  out.obstacles.clear();
  out.environment.wind = {};
  out.collision.enabled = false;
  out.solver.integrator = Integrator::kLeapfrog;
  out.solver.stability_monitor = false;
  return out;
}

double substepOf_s(const Model& model, const Scene& tissue, const std::shared_ptr<ThreadPool>& threads) {
  const double proven_s = kOfSafe * safeTimeStep(model);
  if (!std::all_of(model.bodies.begin(), model.bodies.end(), [](const Body& body) { return body.hasCells(); }))
    return proven_s;
  CpuSolverOptions options;
  options.threads = threads;
  options.allow_unstable = true;
  CpuBackend backend(model, tissue, planTicks(model, tissue, options), options);
  return std::max(proven_s, kOfMeasured * measureLimit_s(backend, model));
}

/// Returns bodies without drag and dashpots: a relaxation changes the drag in every substep.
std::vector<layout::BodyParams> undamped(std::vector<layout::BodyParams> bodies) {
  for (layout::BodyParams& body : bodies) body.mass_damping_per_s = body.dashpot_s = 0;
  return bodies;
}

FeatureSet featuresToSettle(const Model& model, const Scene& tissue, double dt_s) {
  FeatureSet features = featuresOf(model, tissue, dt_s);
  features.dashpot = features.predicted = false;
  return features;
}

double meanSpacing_m(const Model& model) {
  double sum = 0;
  for (const Body& body : model.bodies) sum += body.lattice.spacing_m;
  return sum / static_cast<double>(model.bodies.size());
}

/// Sums over nodes of mass times these terms.
struct Sums {
  double speed2 = 0;   ///< squared velocity [kg m2/s2]
  double size2 = 0;    ///< squared displacement [kg m2]
  double offset2 = 0;  ///< squared displacement since the reference [kg m2]
  double pull = 0;     ///< that displacement . -(change of acceleration) since the reference [kg m2/s2]
  double force2 = 0;   ///< squared force [N2], without the mass
};

/// Leapfrog with a drag that is critical for the slowest motion.
class Relaxation {
 public:
  Relaxation(const Model& model, const Scene& tissue, double dt_s, const ThreadPool& pool)
      : dt_s_(dt_s),
        features_(featuresToSettle(model, tissue, dt_s_)),
        lattice_(model, undamped(bodyParams(model, dt_s_)), features_),
        sleep_(lattice_, 0),
        parallel_(pool),
        gravity_(tissue.environment.gravity_m_per_s2.cast<float>()),
        influences_(bodyInfluences(model, tissue)),
        reference_u_(3 * lattice_.slotCount()),
        reference_a_(3 * lattice_.slotCount()),
        masses_kg_(lattice_.strengths.mass),
        parts_(lattice_.brickCount()) {
    const simd::Kernels kernels = kernelsOrThrow({});
    if (features_.network) network_ = std::make_unique<CpuNetwork>(lattice_, pool, features_, kernels);
    stepper_ = makeCpuStepper(Integrator::kLeapfrog, 0, lattice_, {pool, sleep_, network_.get(), features_, kernels});
    for (const layout::vec4& a : influences_) pushed_ = pushed_ || a.x != 0 || a.y != 0 || a.z != 0;
    for (size_t slot = 0; slot < masses_kg_.size(); ++slot) {
      if (isGhost(lattice_.store.nodes[slot])) masses_kg_[slot] = 0;
    }
    for (const uint32_t slot : lattice_.store.active) {
      if (lattice_.strengths.mobility[slot] <= 0) continue;
      const double mass_kg = static_cast<double>(lattice_.strengths.mass[slot]);
      mass_kg_ += mass_kg;
      load_n_ += std::pow(mass_kg * static_cast<double>((gravity_ + influenceOn(slot)).norm()), 2);
    }
    load_n_ = std::sqrt(load_n_);
    unresolved2_ = mass_kg_ * std::pow(kUnresolved * meanSpacing_m(model), 2);
  }

  /// Runs the relaxation.
  /// @return false if the substep proved too long
  bool run(SettleReport& report) {
    int calm = 0, next = 1;
    for (int s = 0; s < kMostSubsteps && calm < kCalm; ++s, ++report.substeps) {
      // The reference is replaced at substeps 1, 3, 7, 15 ..., then every kWindow substeps.
      const bool renews = s == next;
      if (renews) next += std::min(next + 1, kWindow);
      const Sums sums = substep(s == 0, renews);
      if (s == 0) load_n_ = std::max(load_n_, std::sqrt(sums.force2));
      report.residual = load_n_ > 0 ? std::sqrt(sums.force2) / load_n_ : 0;
      if (!(report.residual < kDiverged)) return false;
      if (renews && sums.offset2 > 0) recordRate(std::max(0.0, sums.pull / sums.offset2));
      calm = isSettled(sums, report) ? calm + 1 : 0;
    }
    report.settled = calm == kCalm;
    return true;
  }

  /// Returns the displacements of the nodes, with zero velocities.
  HostState state() const {
    HostState out = lattice_.read();
    std::fill(out.velocity_m_per_s.begin(), out.velocity_m_per_s.end(), layout::vec4{0, 0, 0, 0});
    return out;
  }

  double largest_m() const {
    float largest = 0;
    for (const uint32_t slot : lattice_.store.active)
      largest = std::max(largest, planesAt(lattice_.state.displacement[lattice_.state.current].data(), slot).norm());
    return static_cast<double>(largest);
  }

 private:
  bool isSettled(const Sums& sums, SettleReport& report) const {
    if (sums.speed2 == 0) report.left = 0;
    const double slowest2 = *std::min_element(rates2_.begin(), rates2_.end());
    if (sums.speed2 == 0 || slowest2 == 0) return sums.speed2 == 0;
    const double offset2 =
        sums.speed2 / slowest2;  // remaining distance of a critically damped motion: mass times squared length
    report.left = sums.size2 > 0 ? std::sqrt(offset2 / sums.size2) : 1;
    if (offset2 <= unresolved2_) return true;
    return report.left <= kLeft && (report.residual <= kSettled || report.left <= kLeftAtMost) &&
           report.residual <= kLargestResidual;
  }

  /// Records a rate. Fast motion in one place hides slow motion elsewhere, so the least of the last windows counts.
  void recordRate(double rate2) {
    rate2_ = rate2;
    rates2_[windows_++ % rates2_.size()] = rate2;
  }

  Vector3f influenceOn(uint32_t slot) const {
    const layout::vec4& a = influences_[lattice_.store.nodes[slot].hi >> layout::kBodyShift];
    return {a.x, a.y, a.z};
  }

  /// Makes one substep.
  /// @param renews  the substep begins at the next reference
  Sums substep(bool first, bool renews) {
    // Leapfrog: v' = ((1 - g) v + kick a) / (1 + g), g = drag kick / 2; the drag is 2 omega of the slowest motion.
    const auto mass_damping_per_s = static_cast<float>(2 * std::sqrt(rate2_));
    for (layout::BodyParams& body : lattice_.store.bodies) body.mass_damping_per_s = mass_damping_per_s;
    Substep step;
    step.dt_s = static_cast<float>(dt_s_);
    step.kick_s = first ? 0.5F * step.dt_s : step.dt_s;
    step.gravity = gravity_;
    step.sleep_distance_m = std::numeric_limits<float>::max();
    step.restarted = first;
    const float g = 0.5F * mass_damping_per_s * step.kick_s;
    stepper_->run(lattice_, step, nullptr);
    lattice_.swap();
    if (pushed_) push(step, g);
    return sum(step.kick_s, g, renews);
  }

  /// Adds the effect of forces on bodies in a substep.
  void push(const Substep& step, float g) {
    float* u = lattice_.state.displacement[lattice_.state.current].data();
    float* v = lattice_.state.velocity[lattice_.state.current].data();
    for (const uint32_t slot : lattice_.store.active) {
      if (lattice_.strengths.mobility[slot] <= 0) continue;
      const Vector3f more = step.kick_s / (1 + g) * influenceOn(slot);
      setPlanes(v, slot, planesAt(v, slot) + more);
      setPlanes(u, slot, planesAt(u, slot) + step.dt_s * more);
    }
  }

  Sums sum(float kick_s, float g, bool renews) {
    constexpr Portions kBricks{4, 64};
    parallel_.ranges(lattice_.brickCount(), kBricks, [&](size_t first, size_t end) {
      for (size_t brick = first; brick < end; ++brick) parts_[brick] = sumBrick(brick, kick_s, g, renews);
    });
    Sums out;
    for (const Sums& part : parts_) {
      out.speed2 += part.speed2;
      out.size2 += part.size2;
      out.offset2 += part.offset2;
      out.pull += part.pull;
      out.force2 += part.force2;
    }
    return out;
  }

  /// Sums over a brick. Accelerations and displacements are those at the beginning of the substep.
  Sums sumBrick(size_t brick, float kick_s, float g, bool renews) {
    const CpuState& state = lattice_.state;
    const float* mass = &masses_kg_[brick * layout::kBrickSlots];
    const size_t at = 3 * layout::kBrickSlots * brick;
    const float *u = &state.displacement[1 - state.current][at], *before = &state.velocity[1 - state.current][at];
    const float* after = &state.velocity[state.current][at];
    float *reference_u = &reference_u_[at], *reference_a = &reference_a_[at];
    float speed2 = 0, size2 = 0, offset2 = 0, pull = 0, force2 = 0;
    for (size_t k = 0; k < 3 * layout::kBrickSlots; ++k) {
      const float m = mass[k % layout::kBrickSlots];
      const float a = ((1 + g) * after[k] - (1 - g) * before[k]) / kick_s, offset = u[k] - reference_u[k];
      speed2 += m * after[k] * after[k];
      size2 += m * u[k] * u[k];
      offset2 += m * offset * offset;
      pull -= m * offset * (a - reference_a[k]);
      force2 += m * a * m * a;
      if (renews) {
        reference_u[k] = u[k];
        reference_a[k] = a;
      }
    }
    return {speed2, size2, offset2, pull, force2};
  }

  double dt_s_;
  FeatureSet features_;
  CpuLattice lattice_;
  Sleep sleep_;
  const Parallel& parallel_;
  Vector3f gravity_;
  std::vector<layout::vec4> influences_;
  /// [3 * slots] displacement [m] and acceleration [m/s2] of an earlier substep, from which the stiffness along the
  /// motion is estimated. Many substeps are between, since rounding errors are as large as the change in one.
  AlignedVector<float> reference_u_, reference_a_;
  /// [slots] weights of the sums; 0 for ghosts. Where ghosts alternate in sign along a clamp, nothing resists them, so
  /// their slow motion says nothing about the tissue.
  AlignedVector<float> masses_kg_;
  std::vector<Sums> parts_;  ///< [bricks]
  std::unique_ptr<CpuNetwork> network_;
  std::unique_ptr<CpuStepper> stepper_;
  bool pushed_ = false;
  double mass_kg_ = 0, load_n_ = 0, unresolved2_ = 0;
  std::array<double, kRates> rates2_{};  ///< of the last windows
  size_t windows_ = 0;
  double rate2_ = 0;  ///< squared angular frequency of the slowest motion [1/s2], by Rayleigh's quotient
};

}  // namespace

HostState equilibriumOf(const Model& model, const Scene& scene, SettleReport& report,
                        const std::shared_ptr<ThreadPool>& threads) {
  requireHeld(model);
  report = {};
  const std::shared_ptr<ThreadPool> pool = threads ? threads : makeThreadPool(scene.solver.threads);
  const Scene tissue = tissueOf(scene);
  const auto start = std::chrono::steady_clock::now();
  double dt_s = substepOf_s(model, tissue, pool);
  for (int attempt = 0; attempt < kAttempts; ++attempt, dt_s *= kShorter) {
    Relaxation relaxation(model, tissue, dt_s, *pool);
    if (!relaxation.run(report)) continue;
    report.seconds = secondsSince(start);
    report.largest_m = relaxation.largest_m();
    if (!report.settled) break;
    return relaxation.state();
  }
  throw Error("no equilibrium was found after " + std::to_string(report.substeps) +
              " substeps: the unbalanced force is " + numberText(report.residual, 3) + " of the load");
}

}  // namespace viscera
