// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "solver/multigrid/tr_bdf2.h"

#include <cmath>

namespace viscera::multigrid {

namespace {

const double kGamma = 2 - std::sqrt(2.0);              // with it both stages have one matrix
const double kSecond = (1 - kGamma) / (2 - kGamma);    // c / dt of BDF2
const double kOfMiddle = 1 / (kGamma * (2 - kGamma));  // A
const double kOfStart = kOfMiddle - 1;                 // B
constexpr double kTakes = 0.2;      // share of the kinetic energy that may be taken to keep energy from growing
constexpr double kRounding = 2e-6;  // of the energies that are summed: float32

}  // namespace

TrBdf2::TrBdf2(StageSolver& solver) : solver_(solver), increment_(solver.start.size()) {}

Stage TrBdf2::stageOf(double dt_s) {
  const double c = kSecond * dt_s;
  return {1 / (c * c), 1 / c};
}

/// Kinetic and elastic energy less the work of gravity on what is free [J].
double TrBdf2::energyOf(const Vectors& u, const Vectors& v, double elastic_j, double& kinetic_j) const {
  const FineLevel& level = solver_.level;
  const size_t n = level.places();
  const Vector3f& g = solver_.gravity;
  kinetic_j = level.sum([&](size_t i) {
    const float speed2 = v[i] * v[i] + v[n + i] * v[n + i] + v[2 * n + i] * v[2 * n + i];
    return static_cast<double>(0.5f * level.free()[i] * level.mass()[i] * speed2);
  });
  const double fallen_j = level.sum([&](size_t i) {
    return static_cast<double>(level.free()[i] * level.mass()[i] *
                               (g.x() * u[i] + g.y() * u[n + i] + g.z() * u[2 * n + i]));
  });
  return kinetic_j + elastic_j - fallen_j;
}

/// dy, dw and the first guess of the trapezoidal stage, from forces at its start.
void TrBdf2::beginFirst(double dt_s, const Vectors& v) {
  const FineLevel& level = solver_.level;
  const size_t n = level.places();
  const auto first = static_cast<float>(kGamma * dt_s), rate = static_cast<float>(solver_.stage.rate_per_s);
  const auto inertia = static_cast<float>(solver_.stage.inertia_per_s2);
  const Vectors& force = level.force();
  level.forPlaces([&](size_t at, size_t count, const layout::BodyParams& body) {
    for (size_t axis = 0; axis < 3; ++axis) {
      const float g = solver_.gravity[static_cast<int>(axis)];
      for (size_t i = at; i < at + count; ++i) {
        const size_t j = axis * n + i;
        const float mass = level.mass()[i];
        const float a = mass > 0 ? level.free()[i] * (force[j] / mass + g - body.drag_per_s * v[j]) : 0;
        solver_.wanted[j] = first * v[j] + a / inertia;
        solver_.offset[j] = v[j] / rate;
        increment_[j] = first * v[j];
      }
    }
  });
}

/// The same of the BDF2 stage, from the solution of the first.
void TrBdf2::beginSecond(double dt_s, const Vectors& v) {
  const size_t n = solver_.level.places();
  const auto rest = static_cast<float>((1 - kGamma) * dt_s), rate = static_cast<float>(solver_.stage.rate_per_s);
  const auto c = static_cast<float>(kSecond * dt_s), a = static_cast<float>(kOfMiddle),
             b = static_cast<float>(kOfStart);
  solver_.level.forPlaces([&](size_t at, size_t count, const layout::BodyParams&) {
    for (size_t axis = 0; axis < 3; ++axis) {
      for (size_t j = axis * n + at; j < axis * n + at + count; ++j) {
        const float speed = rate * (increment_[j] - solver_.offset[j]);
        solver_.offset[j] = a * increment_[j];
        solver_.wanted[j] = a * increment_[j] + c * (a * speed - b * v[j]);
        increment_[j] += rest * speed;
      }
    }
  });
}

bool TrBdf2::step(const Substep& step, Vectors& u, Vectors& v, SolverWork& work) {
  const FineLevel& level = solver_.level;
  const size_t n = level.places();
  const double dt_s = static_cast<double>(step.dt_s);
  solver_.begin(stageOf(dt_s));
  solver_.gravity = step.gravity;
  solver_.start = u;
  double kinetic_j = 0, moved_j = 0;
  const double before_j = energyOf(u, v, solver_.level.linearise(u, v), kinetic_j);
  beginFirst(dt_s, v);
  solver_.solve(increment_, Rule(), work);
  beginSecond(dt_s, v);
  solver_.solve(increment_, Rule(), work);
  const double after_j = energyOf(solver_.displacement, solver_.velocity, solver_.elastic_j, moved_j);
  if (!std::isfinite(after_j)) return false;
  const double excess_j = after_j - before_j - kRounding * (kinetic_j + std::abs(before_j));
  if (excess_j > kTakes * moved_j) return false;
  const float slowed = excess_j > 0 ? static_cast<float>(std::sqrt(1 - excess_j / moved_j)) : 1;
  level.forPlaces([&](size_t at, size_t count, const layout::BodyParams&) {
    for (size_t axis = 0; axis < 3; ++axis) {
      for (size_t i = at; i < at + count; ++i) {
        const size_t j = axis * n + i;
        u[j] = solver_.displacement[j];
        v[j] = level.free()[i] * slowed * solver_.velocity[j];
      }
    }
  });
  return true;
}

}  // namespace viscera::multigrid
