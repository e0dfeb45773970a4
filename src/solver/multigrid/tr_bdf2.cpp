// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "solver/multigrid/tr_bdf2.h"

#include <cmath>

#include "solver/multigrid/step_rules.h"

namespace viscera::multigrid {

TrBdf2::TrBdf2(StageSolver& solver) : solver_(solver), increment_(solver.start.size()) {}

Stage TrBdf2::stageOf(double dt_s) {
  const double c = kSecond * dt_s;
  return {1 / (c * c), 1 / c};
}

/// dy, dw and the first guess of the trapezoidal stage, from forces at its start.
void TrBdf2::beginFirst(double dt_s, const Vectors& v, const Touching* touching) {
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
        const float a =
            mass > 0 ? level.movable()[i] * ((force[j] + solver_.load[j]) / mass + g - body.drag_per_s * v[j]) : 0;
        solver_.wanted[j] = first * v[j] + a / inertia;
        solver_.offset[j] = v[j] / rate;
        increment_[j] = first * v[j];
      }
    }
  });
  if (!touching) return;
  touching->forPressedBefore([&](size_t place) {  // what pressed them balanced these forces
    for (size_t j = place; j < 3 * n; j += n) solver_.wanted[j] = first * v[j];
  });
}

/// The same of the BDF2 stage, from the solution of the first.
void TrBdf2::beginSecond(double dt_s, const Vectors& v, Touching* touching) {
  const size_t n = solver_.level.places();
  if (touching)
    touching->goOnEvenly([&](size_t place) {  // a surface has stopped them, and throws none back
      for (size_t j = place; j < 3 * n; j += n) even_.push_back(increment_[j] / static_cast<float>(kGamma));
    });
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
  if (!touching) return;
  const float* even = even_.data();
  touching->goOnEvenly([&](size_t place) {
    for (size_t j = place; j < 3 * n; j += n) solver_.wanted[j] = increment_[j] = *even++;
  });
  even_.clear();
}

bool TrBdf2::step(const Substep& step, const Vectors& u, const Vectors& v, Touching* touching, SolverWork& work) {
  const FineLevel& level = solver_.level;
  const double dt_s = static_cast<double>(step.dt_s);
  solver_.begin(stageOf(dt_s));
  solver_.gravity = step.gravity;
  solver_.start = u;
  solver_.level.hold({});
  const Energy before = solver_.energy(u, v, solver_.level.evaluate(u, v));
  beginFirst(dt_s, v, touching);
  if (touching) touching->setShare(kGamma);
  solver_.solve(increment_, rule, work, touching);
  beginSecond(dt_s, v, touching);
  if (touching) touching->setShare(1);
  solver_.solve(increment_, rule, work, touching);
  const Energy after = solver_.energy(solver_.displacement, solver_.velocity, solver_.elastic_j);
  const float kept = keptSpeed(before, after, touching ? touching->work(increment_) : 0);
  if (kept == 0) return false;
  if (kept == 1) return true;
  level.forPlaces([&](size_t at, size_t count, const layout::BodyParams&) {
    for (size_t c = 0; c < 3; ++c)
      for (size_t i = c * level.places() + at; i < c * level.places() + at + count; ++i) solver_.velocity[i] *= kept;
  });
  return true;
}

}  // namespace viscera::multigrid
