// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "solver/reference/statics.h"

#include <algorithm>

#include "solver/reference/newton.h"

namespace viscera {

namespace {

constexpr double kSingular =
    1e-13;  ///< least ratio of the smallest to the largest pivot of a stiffness without free motion

/// Elastic energy less the work of gravity and of the external forces, at a share of the full load.
class Potential : public Objective {
 public:
  Potential(const ReferenceSolver& solver, const Field& external_n, double share)
      : solver_(solver), load_n_(solver.slots(), Vector3d::Zero()) {
    for (uint32_t slot : solver.active) {
      if (!isGhost(solver.nodes[slot])) load_n_[slot] = solver.mass(slot) * solver.gravity();
      if (!external_n.empty()) load_n_[slot] += share * external_n[slot];
    }
  }
  double value(const Field& u_m) const override {
    double sum = solver_.elasticEnergy(u_m);
    for (uint32_t slot : solver_.active) sum -= load_n_[slot].dot(u_m[slot]);
    return sum;
  }
  Field gradient(const Field& u_m) const override {
    Field out = solver_.elasticForces(u_m);
    for (uint32_t slot : solver_.active) out[slot] = -out[slot] - load_n_[slot];
    return out;
  }
  Eigen::SparseMatrix<double> hessian(const Field& u_m, ReferenceLattice::Curvature curvature) const override {
    return solver_.stiffnessMatrix(u_m, curvature);
  }
  double forceScale(const Field& u_m) const override {
    double scale = solver_.forceScale(u_m);
    for (const Vector3d& load : load_n_) scale = std::max(scale, load.norm());
    return scale;
  }

 private:
  const ReferenceSolver& solver_;
  Field load_n_;
};

std::vector<bool> freeDofs(const ReferenceSolver& solver, const std::vector<PrescribedDof>& prescribed) {
  std::vector<bool> free(static_cast<size_t>(solver.dofs()), true);
  for (uint32_t slot : solver.active) {
    if (isGhost(solver.nodes[slot]) && !solver.rests(slot)) continue;
    if (!isFixed(solver.nodes[slot]) && !solver.isIsolated(slot) && solver.heldBy(slot) == 0) continue;
    for (int axis = 0; axis < 3; ++axis) free[static_cast<size_t>(solver.dof(slot, axis))] = false;
  }
  for (const PrescribedDof& p : prescribed) free[static_cast<size_t>(solver.dof(p.slot, p.axis))] = false;
  return free;
}

/// Moves the prescribed nodes, and the others to first order: Newton's method then starts near the solution.
void predict(const ReferenceSolver& solver, const Objective& objective, const FreeDofs& free, const Field& change,
             Field& u_m) {
  const Eigen::SparseMatrix<double> k = objective.hessian(u_m, ReferenceLattice::Curvature::kPositive);
  const Eigen::VectorXd forces = flattened(solver, objective.gradient(u_m)) + k * flattened(solver, change);
  for (size_t i = 0; i < u_m.size(); ++i) u_m[i] += change[i];
  Field flat(u_m.size(), Vector3d::Zero());
  for (uint32_t slot : solver.active) flat[slot] = forces.segment<3>(solver.dof(slot, 0));
  free.add(solvePositive(free.of(k), -free.of(flat)), 1, u_m);
}

/// Checks that the body is held: without supports the "solution" is a million times as far away as the lattice is
/// large.
void requireHeld(const ReferenceSolver& solver) {
  Eigen::AlignedBox3d box;
  double farthest = 0;
  for (uint32_t slot : solver.active) {
    box.extend(solver.restPosition(slot));
    farthest = std::max(farthest, solver.u_m[slot].norm());
  }
  if (farthest > 1e6 * box.diagonal().norm())
    throw ConvergenceError("the tissue is not held anywhere: no static equilibrium");
}

Field fieldOf(const ReferenceLattice& lattice, const Eigen::VectorXd& flat) {
  Field out(lattice.slots(), Vector3d::Zero());
  for (uint32_t slot : lattice.active) out[slot] = flat.segment<3>(lattice.dof(slot, 0));
  return out;
}

}  // namespace

StaticsReport solveStatics(ReferenceSolver& solver, const std::vector<PrescribedDof>& prescribed,
                           const Field& external_n, const StaticsOptions& options) {
  const FreeDofs free(solver, freeDofs(solver, prescribed));
  const Field start = solver.u_m;
  StaticsReport total;
  for (int s = 1; s <= options.load_steps; ++s) {
    const double share = static_cast<double>(s) / options.load_steps;
    Field change(solver.slots(), Vector3d::Zero());
    for (const PrescribedDof& p : prescribed) {
      const double from = start[p.slot][p.axis];
      change[p.slot][p.axis] = from + share * (p.u_m - from) - solver.u_m[p.slot][p.axis];
    }
    Potential potential(solver, external_n, share);
    predict(solver, potential, free, change, solver.u_m);
    requireHeld(solver);
    const StaticsReport report = minimise(potential, free, options, LinearSolver::kCholesky, solver.u_m);
    total = {total.iterations + report.iterations + 1, report.residual};
  }
  std::fill(solver.v_m_per_s.begin(), solver.v_m_per_s.end(), Vector3d::Zero());
  return total;
}

Field solveLinear(const ReferenceSolver& solver, const std::vector<PrescribedDof>& prescribed,
                  const Field& external_n) {
  const Field rest(solver.slots(), Vector3d::Zero());
  const FreeDofs free(solver, freeDofs(solver, prescribed));
  Field u = rest;
  for (const PrescribedDof& p : prescribed) u[p.slot][p.axis] = p.u_m;
  const Eigen::SparseMatrix<double> stiffness = solver.stiffnessMatrix(rest);
  Field load = fieldOf(solver, stiffness * flattened(solver, u));
  for (uint32_t slot : solver.active) load[slot] = (external_n.empty() ? rest[slot] : external_n[slot]) - load[slot];
  Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> ldlt(free.of(stiffness));
  if (ldlt.info() != Eigen::Success || ldlt.vectorD().minCoeff() < kSingular * ldlt.vectorD().maxCoeff()) {
    throw ConvergenceError("the prescribed displacements do not prevent a rigid motion: no linear equilibrium");
  }
  free.add(ldlt.solve(free.of(load)), 1, u);
  return u;
}

Field reactions(const ReferenceSolver& solver) {
  Field out = solver.elasticForces(solver.u_m);
  for (Vector3d& force : out) force = -force;
  return out;
}

Field linearReactions(const ReferenceSolver& solver, const Field& u_m) {
  const Field rest(solver.slots(), Vector3d::Zero());
  return fieldOf(solver, solver.stiffnessMatrix(rest) * flattened(solver, u_m));
}

}  // namespace viscera
