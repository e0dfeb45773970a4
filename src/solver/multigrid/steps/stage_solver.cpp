// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "solver/multigrid/steps/stage_solver.h"

#include <cmath>

#include "solver/multigrid/steps/step_rules.h"

#include "viscera/model/body/neighbors.h"

namespace viscera::multigrid {

namespace {

constexpr float kBelow = 0.999f;  // of a bound on that, for its rounding
constexpr float kApart = 0.3f;    // spacings: how far a step may carry a node from those around it

}  // namespace

StageSolver::StageSolver(const Model& model, const CpuLattice& lattice, const Parallel& parallel)
    : level(model, lattice, parallel) {
  for (Vectors* each : {&start, &wanted, &offset, &load, &displacement, &velocity, &r_, &s_, &p_, &q_, &z_, &work_.r,
                        &work_.d, &work_.e, &force_})
    each->assign(3 * level.places(), 0);
  stiffest_n_per_m_ = level.stiffest();
}

void StageSolver::refresh() {
  level.refresh();
}

void StageSolver::begin(const Stage& next) {
  stage = next;
  level.begin(stage);
  levels_ = built_.of(level, stage);
}

void StageSolver::rebuildAside() {
  built_.rebuildAside(level);
}

void StageSolver::takeRebuilt() {
  built_.takeRebuilt();
}

double StageSolver::residual(const Vectors& increment) {
  evaluate(increment, true);
  return masked();
}

double StageSolver::masked() {
  const size_t n = level.places();
  level.forPlaces([&](size_t at, size_t count, const layout::BodyParams&) {
    for (size_t c = 0; c < 3; ++c)
      for (size_t i = at; i < at + count; ++i) r_[c * n + i] *= level.free()[i];
  });
  level.project(r_);
  return std::sqrt(level.dot(r_, r_));
}

void StageSolver::evaluate(const Vectors& increment, bool tangent) {
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
  elastic_j = tangent ? level.linearise(displacement, velocity) : level.evaluate(displacement, velocity);
  const Vectors& force = level.force();
  level.forPlaces([&](size_t at, size_t count, const layout::BodyParams& body) {
    const float drag = body.drag_per_s;
    for (size_t c = 0; c < 3; ++c) {
      const float g = gravity[static_cast<int>(c)];
      for (size_t i = at; i < at + count; ++i) {
        const size_t j = c * n + i;
        const float pull = g + inertia * (wanted[j] - increment[j]) - drag * velocity[j];
        r_[j] = level.movable()[i] * (force[j] + load[j] + level.mass()[i] * pull);
      }
    }
  });
  noise_n = kFloatDisplacement * stiffest_n_per_m_ * std::sqrt(level.dot(displacement, displacement));
}

Energy StageSolver::energy(const Vectors& u, const Vectors& v, double elastic) const {
  const size_t n = level.places();
  Energy out;
  out.kinetic_j = level.sum([&](size_t i) {
    const float speed2 = v[i] * v[i] + v[n + i] * v[n + i] + v[2 * n + i] * v[2 * n + i];
    return static_cast<double>(0.5f * level.movable()[i] * level.mass()[i] * speed2);
  });
  const double fallen_j = level.sum([&](size_t i) {
    const float mass = level.mass()[i];
    return static_cast<double>(level.movable()[i] *
                               ((mass * gravity.x() + load[i]) * u[i] + (mass * gravity.y() + load[n + i]) * u[n + i] +
                                (mass * gravity.z() + load[2 * n + i]) * u[2 * n + i]));
  });
  out.sum_j = out.kinetic_j + elastic - fallen_j;
  return out;
}

/// Largest component of a vector, over the spacing of its body.
float StageSolver::farthest(const Vectors& x) const {
  float out = 0;
  for (const Block& block : level.grid().blocks) {
    float most = 0;
    for (size_t c = 0; c < 3; ++c)
      for (size_t i = c * level.places() + block.at; i < c * level.places() + block.at + kBlock; ++i)
        most = std::max(most, std::abs(x[i]));
    out = std::max(out, most / level.box(block.body).params.origin_spacing.w);
  }
  return out;
}

/// q = A p, A the change of forces at an increment: their difference over a way on which it hardly changes.
void StageSolver::multiply(const Vectors& increment, const Vectors& p, Vectors& q, const Stiffening* stiffening) {
  const size_t n = level.places();
  const float way = kWayOfDifferences / std::max(farthest(p), 1e-30f), per = 1 / way;
  const float rate = static_cast<float>(stage.rate_per_s);
  level.forPlaces([&](size_t at, size_t count, const layout::BodyParams&) {
    for (size_t c = 0; c < 3; ++c) {
      for (size_t i = c * n + at; i < c * n + at + count; ++i) {
        const float there = increment[i] + way * p[i];
        displacement[i] = start[i] + there;
        velocity[i] = rate * (there - offset[i]);
      }
    }
  });
  level.evaluate(displacement, velocity);
  const Vectors& force = level.force();
  level.forPlaces([&](size_t at, size_t count, const layout::BodyParams&) {
    for (size_t c = 0; c < 3; ++c) {
      for (size_t i = at; i < at + count; ++i) {
        const size_t j = c * n + i;
        q[j] = level.free()[i] * (per * (force_[j] - force[j]) + level.diagonal(i) * p[j]);
      }
    }
  });
  if (stiffening) stiffening->addTo(p, q);
  level.project(q);
}

int StageSolver::solveLinear(const Vectors& increment, const Rule& rule, double norm) {
  const int iterations = solveSystem(rule, norm, [&](bool first) { return iterate(increment, rule, first); });
  if (rule.tame) tame();
  return iterations;
}

Iteration StageSolver::iterate(const Vectors& increment, const Rule& rule, bool first) {
  if (first) {
    std::fill(s_.begin(), s_.end(), 0.0f);
    if (rule.exact) force_ = level.force();
  }
  const double rz = rule.side_by_side ? levels_.hierarchy->cycleSideBySide(level, levels_.largest, r_, work_, z_)
                                      : levels_.hierarchy->cycle(level, levels_.largest, r_, work_, z_);
  if (!(rz > 0)) return {};
  level.turn(first ? 0 : static_cast<float>(rz / rz_), z_, p_);
  rz_ = rz;
  rule.exact ? multiply(increment, p_, q_, rule.stiffening) : level.apply(p_, q_);
  const double curvature = level.dot(p_, q_);
  if (!(curvature > 0)) {  // tangents are made positive: only rounding leads here, and what is exact
    if (rule.stiffening) rule.stiffening->sagged();
    if (first && rule.exact) s_ = p_;  // downhill, if no more is known
    return {};
  }
  const float alpha = static_cast<float>(rz / curvature);
  const double left = std::sqrt(level.advance(alpha, p_, q_, s_, r_));
  return {true, static_cast<double>(alpha) * rz, left};
}

/// Nodes of a block that a step may carry away from others: a bound by squares, sum k |d| <= sqrt(sum k sum k d^2).
/// @return a bit each
uint32_t StageSolver::mayBeFar(const Block& block) const {
  const size_t n = level.places();
  const Box& box = level.box(block.body);
  float stiffness[kBlock] = {}, apart2[kBlock] = {};
  for (size_t pair = 0; pair < kPairs; ++pair) {
    const std::array<int, 3>& o = kNeighborOffsets[2 * pair];
    const ptrdiff_t away = o[0] + o[1] * box.row + o[2] * box.layer;
    for (const bool owned : {true, false}) {
      const float* const near = &s_[block.at];
      const float* const far = owned ? near + away : near - away;
      const float* const k = level.stiffnessesOf(pair) + (owned ? block.at : block.at - static_cast<size_t>(away));
      for (size_t i = 0; i < kBlock; ++i) {
        const float x = far[i] - near[i], y = far[n + i] - near[n + i], z = far[2 * n + i] - near[2 * n + i];
        stiffness[i] += k[i];
        apart2[i] += k[i] * (x * x + y * y + z * z);
      }
    }
  }
  const float most = kApart * box.params.origin_spacing.w * kBelow;
  uint32_t out = 0;
  for (size_t i = 0; i < kBlock; ++i) {
    if (apart2[i] > most * most * stiffness[i]) out |= 1u << i;
  }
  return out;
}

/// A step that carries a node away from those around it is none: it hangs on few springs, which a step so long turns to
/// where tangents knew nothing of. It goes on with the others.
void StageSolver::tame() {
  if (!(farthest(s_) > kApart / 4)) return;
  const Grid& grid = level.grid();
  const size_t n = level.places();
  constexpr size_t kPerJob = 32;
  level.parallel()((grid.blocks.size() + kPerJob - 1) / kPerJob, [&](size_t job) {
    for (size_t b = job * kPerJob; b < std::min(grid.blocks.size(), (job + 1) * kPerJob); ++b) {
      const Block& block = grid.blocks[b];
      for (size_t c = 0; c < 3; ++c) std::copy_n(&s_[c * n + block.at], kBlock, &z_[c * n + block.at]);
      const uint32_t far = mayBeFar(block);
      for (size_t i = 0; far >> i != 0; ++i) {
        const int32_t node = grid.node_at[block.at + i];
        if (!(far >> i & 1) || node < 0) continue;
        const Vector3f step = tamedStep(static_cast<uint32_t>(node));
        for (size_t c = 0; c < 3; ++c) z_[c * n + block.at + i] = step[static_cast<int>(c)];
      }
    }
  });
  std::swap(s_, z_);
  level.project(s_);
}

Vector3f StageSolver::tamedStep(uint32_t node) const {
  const uint32_t body = level.grid().bodyOf(node);
  const size_t place = level.grid().place_of[node], n = level.places();
  const Vector3f own(s_[place], s_[n + place], s_[2 * n + place]);
  Vector3f around = Vector3f::Zero();
  float stiffness = 0, apart = 0;
  for (size_t pair = 0; pair < kPairs; ++pair) {
    const std::array<int, 3>& o = kNeighborOffsets[2 * pair];
    for (const int side : {1, -1}) {
      const size_t far = level.grid().beside(body, place, side * o[0], side * o[1], side * o[2]);
      const float k = level.stiffness(pair, side > 0 ? place : far);
      if (k == 0) continue;
      const Vector3f step(s_[far], s_[n + far], s_[2 * n + far]);
      stiffness += k;
      around += k * step;
      apart += k * (step - own).norm();
    }
  }
  const float far = kApart * level.box(body).params.origin_spacing.w;
  if (apart <= far * stiffness || level.free()[place] == 0) return own;
  const Vector3f middle = around / stiffness;
  return middle + far * stiffness / apart * (own - middle);
}

}  // namespace viscera::multigrid
