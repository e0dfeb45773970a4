// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "solver/ticks/stable_step.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "math/float_bits.h"
#include "model/fracture/prestress_balance.h"
#include "model/scene/integrators.h"
#include "solver/tissue/joined_lattice.h"
#include "viscera/solver/stability_monitor.h"

namespace viscera {

namespace {

/// Steps of Lanczos' method: finds the limit to 2 % (test/solver/stable_step_gl_test.cpp).
constexpr int kProducts = 20;
/// Amplitude over the shortest spacing: forces are linear up to it, and float32 resolves them below it.
constexpr double kAmplitude = 1e-4;
/// Arbitrary: the velocities are those that forces give in this time.
constexpr double kKick_s = 1e-4;
/// Ratio of substep to limit, and the dt_fraction that gives it. The dashpot leaves 0.87 and more (docs/physics.md 2,
/// docs/verification.md).
constexpr double kOfLimit = 0.82, kDefaultFraction = 0.75;
/// Share of the limit that the dashpot leaves.
constexpr double kDashpotMargin = 0.94;
/// strainFactor(): slope up to kStrainedStretch, and beyond, where shear needs more (docs/physics.md 2).
constexpr double kPerStretch = 0.4, kPerMore = 0.8;

/// lawFactor(): kStrainMargin multiplies the reduction of the substep by strain, as strain grows within the tick;
/// kWithin of it is covered by kOfLimit. It changes in steps of 1/kPerFactor: substeps that change in every tick make
/// small forces flicker.
constexpr double kStrainMargin = 1.5, kWithin = 0.9, kPerFactor = 20;

/// releasedStiffening(): largest overshoot of the strain of freed cells, and largest change of their length.
constexpr double kOvershoot = 3, kMostReleased = 0.6;

/// Displaces the nodes of bodies with a prestress as if their parts of a label, and all others, were freed.
void letGo(const Model& model, size_t label, HostState& state) {
  for (size_t b = 0; b < model.bodies.size(); ++b) {
    const Body& body = model.bodies[b];
    if (body.prestress.empty()) continue;
    const std::vector<Eigen::Matrix3d> strains = strainsByLabel(body);
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(strains[std::min(label, strains.size() - 1)]);
    const Vector3d step = (-kOvershoot * axes.eigenvalues()).cwiseMax(-kMostReleased).cwiseMin(kMostReleased);
    const Eigen::Matrix3d gradient = axes.eigenvectors() * step.asDiagonal() * axes.eigenvectors().transpose();
    for (const uint32_t slot : body.lattice.active_slots) {
      const Vector3f u = (gradient * (body.lattice.restPosition(slot) - body.lattice.origin_m)).cast<float>();
      state.displacement_m[model.slotOffset(b) + slot] = {u.x(), u.y(), u.z(), 0};
    }
  }
}

/// Nodes that may move, with their masses.
struct Movers {
  std::vector<uint32_t> slots;
  std::vector<double> mass_kg;
  double spacing_m = std::numeric_limits<double>::infinity();
};

Movers moversOf(const Model& model) {
  Movers out;
  const Strengths strengths = allStrengths(model);
  for (size_t b = 0; b < model.bodies.size(); ++b) {
    const Lattice& lattice = model.bodies[b].lattice;
    out.spacing_m = std::min(out.spacing_m, lattice.spacing_m);
    for (const uint32_t local : lattice.active_slots) {
      if (isFixed(lattice.nodes[local])) continue;
      out.slots.push_back(model.slotOffset(b) + local);
      out.mass_kg.push_back(static_cast<double>(strengths.mass_kg[out.slots.back()]));
    }
  }
  return out;
}

/// Operator M^-1 K of a backend's tissue at rest, on vectors with three numbers per mover.
class Tissue {
 public:
  Tissue(SolverBackend& backend, const Model& model)
      : backend_(backend), movers_(moversOf(model)), state_(backend.readState()) {}

  Eigen::Index size() const { return static_cast<Eigen::Index>(3 * movers_.slots.size()); }

  double dot(const Eigen::VectorXd& a, const Eigen::VectorXd& b) const {
    double sum = 0;
    for (size_t i = 0; i < movers_.slots.size(); ++i) {
      const auto at = static_cast<Eigen::Index>(3 * i);
      sum += movers_.mass_kg[i] * a.segment<3>(at).dot(b.segment<3>(at));
    }
    return sum;
  }

  Eigen::VectorXd product(const Eigen::VectorXd& step) {
    const double scale = kAmplitude * movers_.spacing_m / step.cwiseAbs().maxCoeff();
    for (size_t i = 0; i < movers_.slots.size(); ++i) {
      const Vector3f u = (scale * step.segment<3>(static_cast<Eigen::Index>(3 * i))).cast<float>();
      state_.displacement_m[movers_.slots[i]] = {u.x(), u.y(), u.z(), 0};
    }
    backend_.loadState(state_);
    backend_.advance(kick(), false);
    const HostState moved = backend_.readState();
    Eigen::VectorXd out(size());
    for (size_t i = 0; i < movers_.slots.size(); ++i) {
      const layout::vec4& v = moved.velocity_m_per_s[movers_.slots[i]];
      out.segment<3>(static_cast<Eigen::Index>(3 * i)) = -Vector3f(v.x, v.y, v.z).cast<double>() / (kKick_s * scale);
    }
    return out;
  }

 private:
  static Substep kick() {
    Substep step;
    step.dt_s = step.kick_s = static_cast<float>(kKick_s);
    step.sleep_distance_m = std::numeric_limits<float>::max();
    step.restarted = true;
    return step;
  }

  SolverBackend& backend_;
  Movers movers_;
  HostState state_;
};

/// Returns the largest eigenvalue of a tridiagonal matrix plus a bound on its error as one of the operator's.
double largestOf(const std::vector<double>& diagonal, const std::vector<double>& beside) {
  const auto n = static_cast<Eigen::Index>(diagonal.size());
  Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver;
  solver.computeFromTridiagonal(Eigen::Map<const Eigen::VectorXd>(diagonal.data(), n),
                                Eigen::Map<const Eigen::VectorXd>(beside.data(), n - 1));
  return solver.eigenvalues()[n - 1] + beside.back() * std::abs(solver.eigenvectors()(n - 1, n - 1));
}

Eigen::VectorXd someDirection(Eigen::Index size) {
  std::minstd_rand random;  // the same on every machine
  Eigen::VectorXd step(size);
  for (double& x : step) x = static_cast<double>(random()) / static_cast<double>(std::minstd_rand::max()) - 0.5;
  return step;
}

}  // namespace

bool measuresLimit(const Model& model, const SolverConfig& config) {
  const bool lattices =
      std::all_of(model.bodies.begin(), model.bodies.end(), [](const Body& body) { return body.hasCells(); });
  return config.measured_limit && config.stability_monitor && config.substeps == 0 &&
         traitsOf(config.integrator).shortens && lattices;
}

double measureLimit_s(SolverBackend& backend, const Model& model) {
  backend.beginTick();
  Tissue tissue(backend, model);
  std::vector<double> diagonal, beside;
  if (tissue.size() > 0) {
    Eigen::VectorXd step = someDirection(tissue.size()), before = Eigen::VectorXd::Zero(tissue.size());
    step /= std::sqrt(tissue.dot(step, step));
    double link = 0;
    for (int i = 0; i < std::min<Eigen::Index>(kProducts, tissue.size()); ++i) {
      Eigen::VectorXd next = tissue.product(step) - link * before;
      diagonal.push_back(tissue.dot(step, next));
      next -= diagonal.back() * step;
      link = std::sqrt(tissue.dot(next, next));
      beside.push_back(link);
      if (!(link > 1e-9 * diagonal.back())) break;  // the vectors span all that can oscillate
      before = std::move(step);
      step = next / link;
    }
  }
  backend.resetState();
  const double rate = diagonal.empty() ? 0 : largestOf(diagonal, beside);
  return rate > 0 ? 2 / std::sqrt(rate) : std::numeric_limits<double>::infinity();
}

double releasedStiffening(SolverBackend& backend, const Model& model) {
  size_t labels = 0;
  for (const Body& body : model.bodies) {
    if (!body.prestress.empty()) labels = std::max(labels, strainsByLabel(body).size());
  }
  double out = 0;
  for (size_t label = 0; label < labels; ++label) {
    backend.beginTick();
    HostState state = backend.readState();
    letGo(model, label, state);
    backend.loadState(state);
    backend.measure();
    layout::TickStats stats{};
    backend.requestStats();
    backend.takeStats(stats, true);
    out = std::max(out, static_cast<double>(floatFromBits(stats.max_stiffening_bits)));
    backend.resetState();
  }
  return out;
}

double stepWith(double dt_s, double rate_per_s2) {
  return rate_per_s2 > 0 ? 2 / std::sqrt(4 / (dt_s * dt_s) + rate_per_s2) : dt_s;
}

double strainFactor(double stretch) {
  return 1 + kPerStretch * std::min(stretch, kStrainedStretch) + kPerMore * std::max(0.0, stretch - kStrainedStretch);
}

double lawFactor(double stiffening) {
  const double factor = kWithin * (1 + kStrainMargin * (std::sqrt(stiffening) - 1));
  return std::ceil(kPerFactor * std::max(1.0, factor)) / kPerFactor;
}

double measuredSubstep_s(const SolverConfig& config, double stiffness_damping_ratio, double dt_safe_s,
                         double dt_limit_s, double stretch) {
  const double proven_s =
      (stretch > kStrainedStretch ? std::min(config.dt_fraction, config.dt_fraction_strained) : config.dt_fraction) *
      dt_safe_s;
  if (!std::isfinite(dt_limit_s) || !std::isfinite(dt_safe_s)) return proven_s;
  // The dashpot's constant is that of dt_safe: it is a smaller ratio of a slower fastest mode.
  const double largest = stableFraction(config.integrator, stiffness_damping_ratio * dt_safe_s / dt_limit_s);
  const double fraction = std::min(config.dt_fraction * (kOfLimit / kDefaultFraction), kDashpotMargin * largest);
  return std::max(proven_s, fraction * dt_limit_s / strainFactor(stretch));
}

}  // namespace viscera
