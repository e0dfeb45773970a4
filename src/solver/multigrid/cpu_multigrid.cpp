// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "solver/multigrid/cpu_multigrid.h"

#include <cmath>

#include "viscera/math/error.h"

namespace viscera {

namespace {

constexpr int kCorrections = 2;      // Newton steps of a touched step, each followed by sweeps
constexpr int kSweeps = 1;           // of vbd, which find contacts and let go of them
constexpr int kStepsToRebuild = 20;  // after a cut: while a blade moves on, the old hierarchy does
constexpr float kFarthest = 10;      // spacings: a Newton step that would carry a node farther is made shorter
constexpr float kSticks = 0.99f;     // of Coulomb's limit: less than that holds a node

const Model& latticesOnly(const Model& model, const CpuParts& parts) {
  if (model.hasNetwork())
    throw SceneError(
        "solver.integrator: multigrid steps implicit lattices, not bodies with explicit connections: use leapfrog, vbd "
        "or pd");
  if (parts.pairs)
    throw SceneError(
        "solver.integrator: multigrid knows no contacts between nodes (collision.enabled): use leapfrog, vbd or pd");
  return model;
}

/// Nodes beyond sleep_distance_m stop (shaders/solver/step.glsl).
bool isBeyond(const Substep& step, const Vector3f& u, const Vector3f& next) {
  const float far2 = step.sleep_distance_m * step.sleep_distance_m;
  return next.squaredNorm() > far2 && next.squaredNorm() > u.squaredNorm() && (next - u).squaredNorm() <= 0.01f * far2;
}

}  // namespace

CpuMultigrid::CpuMultigrid(const Model& model, const CpuLattice& lattice, const CpuParts& parts)
    : solver_(latticesOnly(model, parts), lattice, parts.parallel),
      tr_bdf2_(solver_),
      sweeps_(lattice, parts.parallel, kSweeps) {
  for (multigrid::Vectors* each : {&displacement_, &velocity_, &increment_}) each->assign(solver_.start.size(), 0);
  solver_.begin(multigrid::TrBdf2::stageOf(parts.dt_s));
}

void CpuMultigrid::run(CpuLattice& lattice, const Substep& step, const layout::ToolMotion* motions) {
  if (springs_changed_) {
    solver_.refresh();
    springs_changed_ = false;
    steps_since_cut_ = 0;
  }
  gather(lattice);
  if (!sweeps_.implicit().hasContacts(step)) {
    solver_.level.hold({});
    if (stepFree(lattice, step)) return followSprings();
  }
  stepTouched(lattice, step, motions);
  followSprings();
}

/// Builds the hierarchy anew when cutting has ended.
void CpuMultigrid::followSprings() {
  if (steps_since_cut_ < 0 || ++steps_since_cut_ < kStepsToRebuild) return;
  solver_.rebuild();
  steps_since_cut_ = -1;
}

void CpuMultigrid::gather(const CpuLattice& lattice) {
  const multigrid::Grid& grid = solver_.level.grid();
  const float* u = lattice.state.displacement[lattice.state.current].data();
  const float* v = lattice.state.velocity[lattice.state.current].data();
  for (uint32_t node = 0; node < grid.nodeCount(); ++node) {
    for (size_t c = 0; c < 3; ++c) {
      const size_t to = c * grid.places() + grid.place_of[node], from = vectorAt(grid.slots[node]) + 64 * c;
      displacement_[to] = u[from];
      velocity_[to] = v[from];
    }
  }
}

bool CpuMultigrid::stepFree(CpuLattice& lattice, const Substep& step) {
  if (!tr_bdf2_.step(step, displacement_, velocity_, work_)) return false;
  const multigrid::Grid& grid = solver_.level.grid();
  const float* now = lattice.state.displacement[lattice.state.current].data();
  float* const u = lattice.state.displacement[1 - lattice.state.current].data();
  float* const v = lattice.state.velocity[1 - lattice.state.current].data();
  for (uint32_t node = 0; node < grid.nodeCount(); ++node) {
    const uint32_t place = grid.place_of[node], slot = grid.slots[node];
    const size_t n = grid.places();
    const Vector3f before = planesAt(now, slot);
    const bool moves = solver_.level.free()[place] > 0;
    Vector3f next(displacement_[place], displacement_[n + place], displacement_[2 * n + place]);
    Vector3f speed(velocity_[place], velocity_[n + place], velocity_[2 * n + place]);
    if (!moves || isBeyond(step, before, next)) {
      next = before;
      speed.setZero();
    }
    setPlanes(u, slot, next);
    setPlanes(v, slot, speed);
  }
  return true;
}

void CpuMultigrid::stepTouched(CpuLattice& lattice, const Substep& step, const layout::ToolMotion* motions) {
  gather(lattice);
  const double dt_s = static_cast<double>(step.dt_s);
  sweeps_.begin(lattice, step, motions);
  solver_.start = displacement_;
  solver_.gravity = step.gravity;
  for (size_t i = 0; i < velocity_.size(); ++i) solver_.wanted[i] = step.dt_s * velocity_[i];
  std::fill(solver_.offset.begin(), solver_.offset.end(), 0.0f);
  solver_.begin({1 / (dt_s * dt_s), 1 / dt_s});
  for (int k = 0; k < kCorrections; ++k) {
    correct(step);
    sweeps_.sweepAll(lattice, step);
  }
  std::fill(solver_.load.begin(), solver_.load.end(), 0.0f);
  sweeps_.end(lattice, step);
}

/// A Newton step of all nodes with the contacts held that press.
void CpuMultigrid::correct(const Substep& step) {
  const multigrid::Grid& grid = solver_.level.grid();
  const size_t n = grid.places();
  std::vector<glsl::vec4>& du = sweeps_.implicit().increments();
  holdContacts(step);
  for (uint32_t node = 0; node < grid.nodeCount(); ++node) {
    const glsl::vec4& from = du[grid.slots[node]];
    for (int c = 0; c < 3; ++c) increment_[static_cast<size_t>(c) * n + grid.place_of[node]] = from[c];
  }
  multigrid::Rule rule;
  rule.newton = 1;
  if (!std::isfinite(solver_.solve(increment_, rule, work_))) return;  // sweeps alone, then
  const multigrid::Vectors& change = solver_.solution();
  float farthest = 0;  // over its spacing
  for (uint32_t node = 0; node < grid.nodeCount(); ++node) {
    const float h = solver_.level.box(grid.bodyOf(node)).params.origin_spacing.w;
    for (size_t c = 0; c < 3; ++c) farthest = std::max(farthest, std::abs(change[c * n + grid.place_of[node]]) / h);
  }
  const float share = std::min(1.0f, kFarthest / std::max(farthest, 1e-6f));
  for (uint32_t node = 0; node < grid.nodeCount(); ++node) {
    const uint32_t place = grid.place_of[node];
    if (solver_.level.free()[place] == 0) continue;
    for (int c = 0; c < 3; ++c) du[grid.slots[node]][c] += share * change[static_cast<size_t>(c) * n + place];
  }
}

/// What increments and contacts say: nodes that are prescribed or stick, planes that nodes keep to, friction of those
/// that slip.
void CpuMultigrid::holdContacts(const Substep& step) {
  const multigrid::Grid& grid = solver_.level.grid();
  const std::vector<glsl::vec4>& du = sweeps_.implicit().increments();
  held_.clear();
  planes_.clear();
  std::fill(solver_.load.begin(), solver_.load.end(), 0.0f);
  for (uint32_t node = 0; node < grid.nodeCount(); ++node) {
    const uint32_t slot = grid.slots[node];
    if (du[slot].w == 0) continue;
    if (du[slot].w > 0) {
      held_.push_back(slot);
      continue;
    }
    int pressing = 0;
    for (const CpuContact& contact : sweeps_.implicit().contactsOf(step, slot)) {
      const float pressure = contact.force.dot(contact.normal);
      if (pressure <= 0) continue;
      const Vector3f drag = contact.force - pressure * contact.normal;
      const bool sticks = contact.friction > 0 && drag.norm() < kSticks * contact.friction * pressure;
      if (sticks || ++pressing > 1) {
        held_.push_back(slot);
        break;
      }
      planes_.push_back({slot, contact.normal});
      for (size_t c = 0; c < 3; ++c) solver_.load[c * grid.places() + grid.place_of[node]] = drag[static_cast<int>(c)];
    }
  }
  solver_.level.hold(held_, planes_);
}

}  // namespace viscera
