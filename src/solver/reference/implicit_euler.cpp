// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
// Implicit Euler, solved to convergence: m (1 + gamma dt)/dt^2 (u+ - y) = F(u+) with
// y = u + (dt v + dt^2 g)/(1 + gamma dt) and dashpots c n n^T ((u+_j - u+_i) - (u_j - u_i))/dt, n of u+.
#include <algorithm>

#include "solver/reference/newton.h"
#include "solver/reference/reference_solver.h"

namespace viscera {

namespace {

constexpr StaticsOptions kNewton{1, 500, 1e-10};

/// The incremental potential, whose minimum is the next state.
class Increment : public Objective {
 public:
  Increment(const ReferenceSolver& solver, Field y_m)
      : solver_(solver), dt_s_(solver.dt_s()), y_m_(std::move(y_m)), frozen_u_m_(solver.u_m) {}

  /// The directions of the dashpots: a potential for them exists only while these stand still.
  void freeze(const Field& u_m) override { frozen_u_m_ = u_m; }

  double value(const Field& u_m) const override {
    double sum = solver_.elasticEnergy(u_m) + dt_s_ * solver_.dissipation(frozen_u_m_, velocity(u_m));
    for (uint32_t slot : solver_.active) sum += 0.5 * inertia(slot) * (u_m[slot] - y_m_[slot]).squaredNorm();
    return sum;
  }

  Field gradient(const Field& u_m) const override {
    Field out = solver_.elasticForces(u_m);
    const Field v = velocity(u_m);
    for (uint32_t slot : solver_.active) {
      out[slot] = inertia(slot) * (u_m[slot] - y_m_[slot]) - out[slot] - solver_.dashpotForce(frozen_u_m_, v, slot);
    }
    return out;
  }

  Eigen::SparseMatrix<double> hessian(const Field& u_m, ReferenceLattice::Curvature curvature) const override {
    Eigen::SparseMatrix<double> out = solver_.stiffnessMatrix(u_m, curvature, 1 / dt_s_);
    for (uint32_t slot : solver_.active) {
      for (int axis = 0; axis < 3; ++axis) {
        const int dof = solver_.dof(slot, axis);
        out.coeffRef(dof, dof) += inertia(slot);
      }
    }
    return out;
  }

  double forceScale(const Field& u_m) const override {
    double scale = solver_.forceScale(u_m);
    for (uint32_t slot : solver_.active) scale = std::max(scale, inertia(slot) * (u_m[slot] - y_m_[slot]).norm());
    return scale;
  }

 private:
  double inertia(uint32_t slot) const {
    return solver_.mass(slot) * (1 + solver_.drag_per_s(slot) * dt_s_) / (dt_s_ * dt_s_);
  }
  Field velocity(const Field& u_m) const {
    Field v(u_m.size(), Vector3d::Zero());
    for (uint32_t slot : solver_.active) v[slot] = (u_m[slot] - solver_.u_m[slot]) / dt_s_;
    return v;
  }

  const ReferenceSolver& solver_;
  double dt_s_;
  Field y_m_, frozen_u_m_;
};

}  // namespace

/// Tools: held nodes are prescribed where the stylus has them at the end of the substep, so the solution knows of them;
/// the velocity given back for them is the one that the forces alone would give, and the tool's impulse is the rest, as
/// in leapfrog. Probes are not in the solution: after it they push nodes out and set their velocities, as in leapfrog.
void ReferenceSolver::implicitEuler(const SubstepMotions& motions, Field& u_next, Field& v_next) const {
  Field y = u_m;
  std::vector<bool> free(static_cast<size_t>(dofs()), false);
  for (uint32_t slot : active) {
    if (rests(slot)) continue;
    if (const uint32_t held_by = heldBy(slot)) {
      u_next[slot] = y[slot] = heldDisplacement(motions[held_by - 1], slot);
      continue;
    }
    y[slot] += dt_s_ * (v_m_per_s[slot] + dt_s_ * gravity_) / (1 + drag_per_s(slot) * dt_s_);
    for (int axis = 0; axis < 3; ++axis) free[static_cast<size_t>(dof(slot, axis))] = true;
  }
  Increment increment(*this, std::move(y));
  minimise(increment, FreeDofs(*this, free), kNewton, LinearSolver::kConjugateGradients, u_next);
  for (uint32_t slot : active) {
    if (!rests(slot)) v_next[slot] = (u_next[slot] - u_m[slot]) / dt_s_;
  }
  const Field v_end = v_next;
  for (uint32_t slot : active) {
    if (rests(slot) || heldBy(slot) == 0) continue;
    const Vector3d force = elasticForce(u_next, slot) + dashpotForce(u_next, v_end, slot);
    v_next[slot] = (v_m_per_s[slot] + dt_s_ * (force / mass(slot) + gravity_)) / (1 + drag_per_s(slot) * dt_s_);
  }
}

}  // namespace viscera
