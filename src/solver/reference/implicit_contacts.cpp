// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "solver/reference/implicit_contacts.h"

#include <cmath>

namespace viscera {

namespace {

constexpr StaticsOptions kNewton{1, 500, 1e-10};
constexpr int kGuesses = 300;       // guesses of the active contacts
constexpr double kBalanced = 1e-9;  // of the largest force: tensions below it are rounding
constexpr double kSteady = 1e-7;    // of the largest force: pressures that change by less have converged
constexpr double kFirstSmooth_m = 1e-6, kSmooth_m = 1e-9;  // smaller slips do not count as sliding
constexpr double kParallel = 1e-6;  // of a unit vector: a smaller remainder is no independent direction

}  // namespace

ImplicitContacts::ImplicitContacts(const ReferenceSolver& solver, const SubstepMotions& motions, std::vector<bool> free)
    : solver_(solver), motions_(motions), free_(std::move(free)) {}

void ImplicitContacts::solve(Increment& increment, const Field& y_m, Field& u_m) {
  Field predicted = u_m;
  for (uint32_t slot : solver_.active) {
    if (free_[slot]) predicted[slot] = y_m[slot];
  }
  find(predicted);
  nodes_.emplace(solver_, outside(predicted));
  const double scale_n_per_m = nodes_->empty() ? 0 : stiffestNode(increment, u_m);
  for (int guess = 0; guess < kGuesses; ++guess) {
    place(u_m);
    increment.setDrags(drags());
    if (!nodes_->empty()) nodes_->tell(increment, scale_n_per_m);
    balance(increment, u_m);
    scale_n_ = increment.forceScale(u_m);
    const bool found = find(u_m), mended = mend(increment, u_m);
    if (!nodes_->mend(increment, u_m, kSteady * scale_n_) && !mended && !found) return;
  }
  throw ConvergenceError("no set of contacts fits the substep");
}

/// Returns the first iterate moved out of the probes and obstacles that it ends in, for the search for contacts between
/// nodes.
Field ImplicitContacts::outside(Field predicted_m) const {
  constexpr int kRounds = 4;
  for (int round = 0; round < kRounds; ++round) {
    for (const Contact& c : contacts_) {
      const Vector3d& n = c.space.normal;
      const double missing_m = c.space.least_m - n.dot(predicted_m[c.slot] - solver_.u_m[c.slot]);
      predicted_m[c.slot] += std::max(0.0, missing_m) * n;
    }
  }
  return predicted_m;
}

/// Returns the largest stiffness plus inertia of a node [N/m].
double ImplicitContacts::stiffestNode(const Increment& increment, const Field& u_m) const {
  return increment.hessian(u_m, ReferenceLattice::Curvature::kPositive).diagonal().maxCoeff();
}

/// Finds the equilibrium under the guess. Friction has a kink where sliding ends: its smoothing is reduced in steps.
void ImplicitContacts::balance(Increment& increment, Field& u_m) const {
  const double first_m = increment.drags().empty() ? kSmooth_m : kFirstSmooth_m;
  for (double smooth_m = first_m; smooth_m > 0.9 * kSmooth_m; smooth_m /= 10) {
    increment.setSmoothness(smooth_m);
    minimise(increment, freeDofs(), kNewton, LinearSolver::kCholesky, u_m);
  }
}

void ImplicitContacts::add(uint32_t slot, size_t owner, const std::optional<HalfSpace>& space) {
  if (!space) return;
  for (const Contact& contact : contacts_) {
    if (contact.slot == slot && contact.owner == owner) return;
  }
  HalfSpace limited = *space;
  const double most_m =
      solver_.options_.push_speed_m_per_s * solver_.dt_s() + std::max(0.0, space->offset_m.dot(space->normal));
  limited.least_m = std::min(limited.least_m, most_m);
  contacts_.push_back({slot, owner, limited});
}

/// Finds contacts of nodes that end inside something. @return whether there are new ones
bool ImplicitContacts::find(const Field& u_m) {
  const size_t before = contacts_.size();
  for (uint32_t slot : solver_.active) {
    if (!free_[slot]) continue;
    const Vector3d rest = solver_.restPosition(slot), x = rest + solver_.u_m[slot], x_next = rest + u_m[slot];
    const double below_m = solver_.surfaceDepth(slot);
    for (size_t s = 0; s < layout::kMaxStyluses; ++s) {
      if (pushesByTip(motions_[s])) add(slot, s, outsideOfProbe(tipOf(motions_[s]), x, x_next, below_m));
      if (pushesByShaft(motions_[s])) add(slot, s, outsideOfProbe(shaftNear(motions_[s], x_next), x, x_next, below_m));
    }
    for (size_t o = 0; o < solver_.obstacles_.size(); ++o) {
      add(slot, layout::kMaxStyluses + o, solver_.obstacles_[o].enlarged(below_m).outside(x, x_next));
    }
  }
  return contacts_.size() > before;
}

/// Moves nodes with active contacts onto their surfaces.
void ImplicitContacts::place(Field& u_m) const {
  constexpr int kRounds = 50;  // alternating projections for nodes with several contacts
  for (int round = 0; round < kRounds; ++round) {
    for (const Contact& c : contacts_) {
      if (!c.presses) continue;
      const Vector3d du = u_m[c.slot] - solver_.u_m[c.slot];
      const Vector3d& n = c.space.normal;
      u_m[c.slot] += (c.space.least_m - du.dot(n)) * n;
    }
  }
}

/// Returns orthonormal directions in which a node's active contacts prevent motion.
std::vector<Vector3d> ImplicitContacts::fixedDirections(uint32_t slot) const {
  std::vector<Vector3d> out;
  const auto fix = [&out](Vector3d direction) {
    for (const Vector3d& other : out) direction -= direction.dot(other) * other;
    if (direction.norm() > kParallel) out.push_back(direction.normalized());
  };
  for (const Contact& c : contacts_) {
    if (c.slot != slot || !c.presses) continue;
    fix(c.space.normal);
  }
  return out;
}

FreeDofs ImplicitContacts::freeDofs() const {
  std::vector<Eigen::Triplet<double>> columns;
  int count = 0;
  for (uint32_t slot : solver_.active) {
    if (!free_[slot]) continue;
    std::vector<Vector3d> basis = fixedDirections(slot);
    const size_t fixed = basis.size();
    for (int axis = 0; axis < 3; ++axis) {
      Vector3d direction = Vector3d::Unit(axis);
      for (int twice = 0; twice < 2; ++twice) {
        for (const Vector3d& other : basis) direction -= direction.dot(other) * other;
      }
      if (basis.size() == 3 || direction.norm() < 0.5)
        continue;  // of three axes one is at most 0.58 from the remainder
      basis.push_back(direction.normalized());
    }
    for (size_t i = fixed; i < basis.size(); ++i, ++count) {
      for (int axis = 0; axis < 3; ++axis) columns.emplace_back(solver_.dof(slot, axis), count, basis[i][axis]);
    }
  }
  Eigen::SparseMatrix<double> directions(solver_.dofs(), count);
  directions.setFromTriplets(columns.begin(), columns.end());
  return FreeDofs(solver_, std::move(directions));
}

/// Returns the friction under the pressures of the guess.
std::vector<Increment::Drag> ImplicitContacts::drags() const {
  std::vector<Increment::Drag> out;
  for (const Contact& c : contacts_) {
    const double limit_n = c.space.friction * c.pressure_n;
    if (!c.presses || limit_n <= 0) continue;
    out.push_back({c.slot, c.space.normal, solver_.u_m[c.slot] + c.space.offset_m, limit_n, -1, Vector3d::Zero()});
  }
  if (nodes_) nodes_->addDrags(out);
  return out;
}

/// Corrects the guess: deactivates contacts in tension, activates violated ones, and takes the current pressures.
/// @return whether anything changed
bool ImplicitContacts::mend(const Increment& increment, const Field& u_m) {
  const Field gradient = increment.gradient(u_m);
  bool changed = false;
  for (Contact& c : contacts_) {
    const Vector3d du = u_m[c.slot] - solver_.u_m[c.slot];
    const Vector3d& n = c.space.normal;
    if (!c.presses) {
      const double rounding_m = 1e-12 * (std::abs(c.space.least_m) + du.norm());
      if (n.dot(du) < c.space.least_m - rounding_m) c.presses = changed = true;
      continue;
    }
    // A node's force is split among its contacts by the directions of their normals.
    Vector3d needed = gradient[c.slot];
    for (const Contact& other : contacts_) {
      if (&other == &c || other.slot != c.slot || !other.presses) continue;
      const Vector3d& m = other.space.normal;
      const double alike = m.dot(n);
      if (1 - alike * alike < kParallel) continue;
      const double share = (needed.dot(m) - alike * needed.dot(n)) / (1 - alike * alike);
      needed -= share * m;
    }
    const double pressure_n = needed.dot(n);
    if (pressure_n < -kBalanced * scale_n_) {
      c.presses = false;
      c.pressure_n = 0;
      c.force_n.setZero();
      changed = true;
      continue;
    }
    if (c.space.friction > 0) changed |= std::abs(pressure_n - c.pressure_n) > kSteady * scale_n_;
    c.pressure_n = std::max(0.0, pressure_n);
    c.force_n = c.pressure_n * n;
    for (const Increment::Drag& d : increment.drags()) {
      if (d.slot == c.slot && d.other < 0 && d.normal == n) c.force_n += d.force(u_m, increment.smoothness());
    }
  }
  return changed;
}

void ImplicitContacts::give(ReferenceSolver& solver, Field& v_next) const {
  nodes_->bounce(free_, v_next);
  for (const Contact& c : contacts_) {
    if (!c.presses) continue;
    if (c.owner < layout::kMaxStyluses) {
      solver.impulse_n_s[c.owner] += solver.dt_s() * c.force_n;
      continue;
    }
    const Vector3d surface = c.space.offset_m / solver.dt_s();
    const double approach = -c.space.normal.dot(solver.v_m_per_s[c.slot] - surface);
    const double now = c.space.normal.dot(v_next[c.slot] - surface);
    Vector3d bounce = Vector3d::Zero();
    if (approach > solver.restingSpeed()) bounce = std::max(0.0, c.space.restitution * approach - now) * c.space.normal;
    v_next[c.slot] += bounce;
    solver.obstacle_impulse_n_s[c.owner - layout::kMaxStyluses] +=
        solver.dt_s() * c.force_n + solver.mass(c.slot) * bounce;
  }
}

}  // namespace viscera
