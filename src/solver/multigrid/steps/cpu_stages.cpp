// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "solver/multigrid/steps/cpu_stages.h"

#include "solver/multigrid/steps/step_rules.h"

namespace viscera::multigrid {

CpuStages::CpuStages(const Model& model, const CpuLattice& lattice, const Parallel& parallel)
    : solver(model, lattice, parallel) {
  for (Vectors* each : {&before, &increment, &kept_}) each->assign(solver.start.size(), 0);
}

/// Calls each(j) for components of all nodes, side by side.
template <class Each>
void CpuStages::forComponents(const Each& each) {
  const size_t n = solver.level.places();
  solver.level.forPlaces([&](size_t at, size_t count, const layout::BodyParams&) {
    for (size_t c = 0; c < 3; ++c)
      for (size_t j = c * n + at; j < c * n + at + count; ++j) each(j);
  });
}

void CpuStages::beginStep(const Substep& step, Touching* touching) {
  dt_s_ = step.dt_s;
  touching_ = touching;
  solver.gravity = step.gravity;
}

Energy CpuStages::start() {
  solver.level.hold({});
  return solver.energy(solver.start, before, solver.level.evaluate(solver.start, before));
}

void CpuStages::setShare(double share) {
  if (touching_) touching_->setShare(share);
}

void CpuStages::beginTrapezoidal() {
  const FineLevel& level = solver.level;
  const size_t n = level.places();
  const auto first = static_cast<float>(kGamma * static_cast<double>(dt_s_)),
             rate = static_cast<float>(solver.stage.rate_per_s);
  const auto inertia = static_cast<float>(solver.stage.inertia_per_s2);
  const Vectors& force = level.force();
  level.forPlaces([&](size_t at, size_t count, const layout::BodyParams& body) {
    for (size_t axis = 0; axis < 3; ++axis) {
      const float g = solver.gravity[static_cast<int>(axis)];
      for (size_t i = at; i < at + count; ++i) {
        const size_t j = axis * n + i;
        const float mass = level.mass()[i];
        const float a =
            mass > 0 ? level.movable()[i] * ((force[j] + solver.load[j]) / mass + g - body.drag_per_s * before[j]) : 0;
        solver.wanted[j] = first * before[j] + a / inertia;
        solver.offset[j] = before[j] / rate;
        increment[j] = first * before[j];
      }
    }
  });
  if (!touching_) return;
  touching_->forPressedBefore([&](size_t place) {  // what pressed them balanced these forces
    for (size_t j = place; j < 3 * n; j += n) solver.wanted[j] = first * before[j];
  });
}

void CpuStages::beginBdf2() {
  const size_t n = solver.level.places();
  if (touching_)
    touching_->goOnEvenly([&](size_t place) {  // a surface has stopped them, and throws no node back
      for (size_t j = place; j < 3 * n; j += n) even_.push_back(increment[j] / static_cast<float>(kGamma));
    });
  const double dt_s = static_cast<double>(dt_s_);
  const auto rest = static_cast<float>((1 - kGamma) * dt_s), rate = static_cast<float>(solver.stage.rate_per_s);
  const auto c = static_cast<float>(kSecond * dt_s), a = static_cast<float>(kOfMiddle),
             b = static_cast<float>(kOfStart);
  forComponents([&](size_t j) {
    const float speed = rate * (increment[j] - solver.offset[j]);
    solver.offset[j] = a * increment[j];
    solver.wanted[j] = a * increment[j] + c * (a * speed - b * before[j]);
    increment[j] += rest * speed;
  });
  if (!touching_) return;
  const float* even = even_.data();
  touching_->goOnEvenly([&](size_t place) {
    for (size_t j = place; j < 3 * n; j += n) solver.wanted[j] = increment[j] = *even++;
  });
  even_.clear();
}

void CpuStages::beginStage(uint32_t stage) {
  if (stage == layout::kStageTrapezoidal) return beginTrapezoidal();
  if (stage == layout::kStageBdf2) return beginBdf2();
  for (size_t j = 0; j < before.size(); ++j) solver.wanted[j] = dt_s_ * before[j];
  std::fill(solver.offset.begin(), solver.offset.end(), 0.0f);
  std::fill(increment.begin(), increment.end(), 0.0f);
}

StageWork::Balance CpuStages::balance(bool tangent) {
  tangent_ = tangent;
  if (touching_) touching_->place(increment);
  solver.evaluate(increment, tangent);
  Balance out;
  out.changed = touching_ && touching_->press(solver.lacking(), increment, solver.level);
  out.residual_n = solver.masked();
  out.noise_n = solver.noise_n;
  return out;
}

Energy CpuStages::energy() const {
  return solver.energy(solver.displacement, solver.velocity, solver.elastic_j);
}

double CpuStages::lag_j() const {
  const FineLevel& level = solver.level;
  const size_t n = level.places();
  const auto inertia = static_cast<float>(solver.stage.inertia_per_s2);
  return level.sum([&](size_t i) {
    double off2 = 0;
    for (size_t j = i; j < 3 * n; j += n) {
      const float off = increment[j] - solver.wanted[j];
      off2 += static_cast<double>(off * off);
    }
    return off2 * static_cast<double>(0.5f * level.movable()[i] * inertia * level.mass()[i]);
  });
}

Iteration CpuStages::iterate(bool first) {
  if (first && !tangent_) solver.level.linearise(solver.displacement, solver.velocity);
  return solver.iterate(increment, Rule(), first);
}

void CpuStages::addSolution(bool tame) {
  if (tame) solver.tame();
  forComponents([&](size_t j) { increment[j] += solver.solution()[j]; });
}

void CpuStages::become(uint32_t what, float share) {
  if (what == layout::kIncrementKeep) {
    kept_ = increment;
  } else if (what == layout::kIncrementSlow) {
    forComponents([&](size_t j) { solver.velocity[j] *= share; });
  } else if (what == layout::kIncrementBack) {
    for (size_t j = 0; j < kept_.size(); ++j) increment[j] = kept_[j] + share * (increment[j] - kept_[j]);
  } else {
    const Vectors& of = what == layout::kIncrementGuess ? solver.wanted : kept_;
    for (size_t j = 0; j < of.size(); ++j) increment[j] = share * of[j];
  }
}

}  // namespace viscera::multigrid
