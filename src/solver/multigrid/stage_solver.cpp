// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "solver/multigrid/stage_solver.h"

#include <cmath>

namespace viscera::multigrid {

namespace {

constexpr double kOtherStage = 4;  // times as much inertia: another hierarchy is worth its building
constexpr double kFloat = 6e-8;    // of a displacement: its rounding in float32, which springs turn into forces

}  // namespace

StageSolver::StageSolver(const Model& model, const CpuLattice& lattice, const Parallel& parallel)
    : level(model, lattice, parallel) {
  for (Vectors* each :
       {&start, &wanted, &offset, &load, &displacement, &velocity, &r_, &s_, &p_, &q_, &z_, &d_, &work_})
    each->assign(3 * level.places(), 0);
  for (uint32_t node = 0; node < level.grid().nodeCount(); ++node) {
    double k = 0;
    for (size_t pair = 0; pair < kPairs; ++pair)
      k += 2 * static_cast<double>(level.stiffness(pair, level.grid().place_of[node]));
    stiffest_n_per_m_ = std::max(stiffest_n_per_m_, k);
  }
}

void StageSolver::refresh() {
  level.refresh();
}

void StageSolver::begin(const Stage& next) {
  stage = next;
  level.begin(stage);
  for (now_ = 0; now_ < built_.size(); ++now_) {
    const double of = built_[now_].stage.inertia_per_s2, wanted = stage.inertia_per_s2;
    if (wanted <= kOtherStage * of && of <= kOtherStage * wanted) return;
  }
  build();
}

void StageSolver::rebuild() {
  built_.clear();
  build();
}

void StageSolver::build() {
  level.hold({});  // who is held today is not tomorrow: only the finest level knows
  Built next{stage, std::make_unique<Hierarchy>(level)};
  std::fill(displacement.begin(), displacement.end(), 0.0f);
  std::fill(velocity.begin(), velocity.end(), 0.0f);
  level.linearise(displacement, velocity);
  next.largest = largestOf(level);
  now_ = built_.size();
  built_.push_back(std::move(next));
}

double StageSolver::residual(const Vectors& increment) {
  const size_t n = level.places();
  const float rate = static_cast<float>(stage.rate_per_s), inertia = static_cast<float>(stage.inertia_per_s2);
  level.forPlaces([&](size_t at, size_t count, const layout::BodyParams&) {
    for (size_t c = 0; c < 3; ++c) {
      for (size_t i = c * n + at; i < c * n + at + count; ++i) {
        displacement[i] = start[i] + increment[i];
        velocity[i] = rate * (increment[i] - offset[i]);
      }
    }
  });
  elastic_j = level.linearise(displacement, velocity);
  const Vectors& force = level.force();
  level.forPlaces([&](size_t at, size_t count, const layout::BodyParams& body) {
    const float drag = body.drag_per_s;
    for (size_t c = 0; c < 3; ++c) {
      const float g = gravity[static_cast<int>(c)];
      for (size_t i = at; i < at + count; ++i) {
        const size_t j = c * n + i;
        const float pull = g + inertia * (wanted[j] - increment[j]) - drag * velocity[j];
        r_[j] = level.free()[i] * (force[j] + load[j] + level.mass()[i] * pull);
      }
    }
  });
  level.project(r_);
  noise_n = kFloat * stiffest_n_per_m_ * std::sqrt(level.dot(displacement, displacement));
  return std::sqrt(level.dot(r_, r_));
}

int StageSolver::solveLinear(const Rule& rule, double norm) {
  const size_t n = level.places();
  const double enough = rule.tolerance * norm;
  double before = 0;
  std::fill(s_.begin(), s_.end(), 0.0f);
  int k = 0;
  while (k < rule.most) {
    built_[now_].hierarchy->cycle(level, built_[now_].largest, r_, work_, d_, z_);
    const double rz = level.dot(r_, z_);
    if (!(rz > 0)) break;
    const float beta = k == 0 ? 0 : static_cast<float>(rz / before);
    before = rz;
    level.forPlaces([&](size_t at, size_t count, const layout::BodyParams&) {
      for (size_t c = 0; c < 3; ++c)
        for (size_t i = c * n + at; i < c * n + at + count; ++i) p_[i] = z_[i] + (beta == 0 ? 0 : beta * p_[i]);
    });
    level.apply(p_, q_);
    const double curvature = level.dot(p_, q_);
    if (!(curvature > 0)) break;  // as tangents are made positive, only rounding leads here
    const float alpha = static_cast<float>(rz / curvature);
    level.forPlaces([&](size_t at, size_t count, const layout::BodyParams&) {
      for (size_t c = 0; c < 3; ++c) {
        for (size_t i = c * n + at; i < c * n + at + count; ++i) {
          s_[i] += alpha * p_[i];
          r_[i] -= alpha * q_[i];
        }
      }
    });
    ++k;
    if (k >= rule.least && std::sqrt(level.dot(r_, r_)) <= enough) break;
  }
  return k;
}

double StageSolver::solve(Vectors& increment, const Rule& rule, SolverWork& work) {
  const size_t n = level.places();
  double norm = residual(increment);
  for (int step = 0; step < rule.newton; ++step) {
    if (norm <= noise_n) break;
    work.iterations += static_cast<uint64_t>(solveLinear(rule, norm));
    ++work.systems;
    level.forPlaces([&](size_t at, size_t count, const layout::BodyParams&) {
      for (size_t c = 0; c < 3; ++c)
        for (size_t i = c * n + at; i < c * n + at + count; ++i) increment[i] += s_[i];
    });
    const double left = residual(increment);
    const bool done = left <= rule.again * norm;
    norm = left;
    if (done) break;
  }
  return norm;
}

}  // namespace viscera::multigrid
