// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "solver/reference/newton.h"

#include <cmath>
#include <limits>
#include <optional>

#include "math/number_text.h"

namespace viscera {

namespace {

using Cholesky = Eigen::SimplicialLLT<Eigen::SparseMatrix<double>>;
using Curvature = ReferenceLattice::Curvature;

constexpr double kArmijo = 1e-4;         ///< share of the predicted descent that a step must achieve
constexpr double kSmallestShare = 1e-9;  ///< smallest share of a step that the search tries
constexpr double kSameValue = 1e-9;      ///< share of the value: a smaller predicted descent is hidden by rounding
constexpr double kSolved = 1e-4;         ///< residual over right-hand side at which conjugate gradients stop
constexpr double kRounding = 1e-14;      ///< share of the value: smaller changes are invisible

/// Returns the solution of (H + shift) x = b, or nothing if that is not positive definite.
std::optional<Eigen::VectorXd> solveShifted(const Eigen::SparseMatrix<double>& h, double shift,
                                            const Eigen::VectorXd& b) {
  Cholesky cholesky;
  cholesky.setShift(shift);
  cholesky.compute(h);
  if (cholesky.info() != Eigen::Success) return std::nullopt;
  return cholesky.solve(b);
}

/// Returns the solution of H x = b to kSolved, preconditioned with the diagonal; nothing if H is found not to be
/// positive.
std::optional<Eigen::VectorXd> solveByGradients(const Eigen::SparseMatrix<double>& h, const Eigen::VectorXd& b) {
  const Eigen::VectorXd scale = h.diagonal().cwiseAbs().cwiseInverse();
  Eigen::VectorXd x = Eigen::VectorXd::Zero(b.size()), r = b, z = scale.cwiseProduct(r), p = z;
  for (Eigen::Index i = 0; i < 10 * b.size() && r.norm() > kSolved * b.norm(); ++i) {
    const Eigen::VectorXd hp = h * p;
    const double curvature = p.dot(hp), descent = r.dot(z);
    if (curvature <= 0) return std::nullopt;
    x += descent / curvature * p;
    r -= descent / curvature * hp;
    z = scale.cwiseProduct(r);
    p = z + r.dot(z) / descent * p;
  }
  return x;
}

/// Returns the step with the true curvature, or slightly more, where that is positive; else with the nearest positive
/// one.
Eigen::VectorXd choleskyStep(const Objective& objective, const FreeDofs& free, const Field& u_m,
                             const Eigen::VectorXd& gradient) {
  const Eigen::SparseMatrix<double> h = free.of(objective.hessian(u_m, Curvature::kTrue));
  const double stiffest = h.diagonal().cwiseAbs().maxCoeff();
  for (double share : {0.0, 1e-3, 1e-2, 0.1}) {
    if (const auto step = solveShifted(h, share * stiffest, -gradient)) return *step;
  }
  return solvePositive(free.of(objective.hessian(u_m, Curvature::kPositive)), -gradient);
}

Eigen::VectorXd conjugateGradientStep(const Objective& objective, const FreeDofs& free, const Field& u_m,
                                      const Eigen::VectorXd& gradient) {
  for (Curvature curvature : {Curvature::kTrue, Curvature::kPositive}) {
    if (const auto step = solveByGradients(free.of(objective.hessian(u_m, curvature)), -gradient)) return *step;
  }
  return choleskyStep(objective, free, u_m, gradient);  // rounding made a curvature of zero negative
}

/// Moves along the step until the value falls enough. Near the end, where values differ little but for rounding, moves
/// until the gradient shrinks, or the full step, which leads away from a saddle. Returns false if no share of the step
/// is acceptable.
bool search(const Objective& objective, const FreeDofs& free, const Eigen::VectorXd& gradient,
            const Eigen::VectorXd& step, Field& u_m) {
  const double before = objective.value(u_m), slope = gradient.dot(step);
  for (double share = 1; share > kSmallestShare; share /= 2) {
    Field trial = u_m;
    free.add(step, share, trial);
    const double value = objective.value(trial);
    bool better = value <= before + kArmijo * share * slope;
    const double promised = -share * slope / (std::abs(value) + std::abs(before));
    if (!better && promised <= kSameValue) better = free.of(objective.gradient(trial)).norm() < gradient.norm();
    better |= promised <= kRounding;
    if (!better) continue;
    u_m.swap(trial);
    return true;
  }
  return false;
}

std::string scientific(double value) {
  TextOut out;
  out << value;
  return out.str();
}

}  // namespace

FreeDofs::FreeDofs(const ReferenceLattice& lattice, const std::vector<bool>& free) : lattice_(lattice) {
  std::vector<Eigen::Triplet<double>> ones;
  for (size_t dof = 0; dof < free.size(); ++dof) {
    if (free[dof]) ones.emplace_back(static_cast<int>(dof), static_cast<int>(ones.size()), 1.0);
  }
  select_.resize(lattice.dofs(), static_cast<int>(ones.size()));
  select_.setFromTriplets(ones.begin(), ones.end());
}

Eigen::VectorXd FreeDofs::of(const Field& field) const {
  return select_.transpose() * flattened(lattice_, field);
}

Eigen::SparseMatrix<double> FreeDofs::of(const Eigen::SparseMatrix<double>& matrix) const {
  return select_.transpose() * matrix * select_;
}

void FreeDofs::add(const Eigen::VectorXd& step, double share, Field& field) const {
  const Eigen::VectorXd all = select_ * step;
  for (size_t i = 0; i < lattice_.active.size(); ++i) {
    field[lattice_.active[i]] += share * all.segment<3>(3 * static_cast<Eigen::Index>(i));
  }
}

Eigen::VectorXd flattened(const ReferenceLattice& lattice, const Field& field) {
  Eigen::VectorXd out(lattice.dofs());
  for (size_t i = 0; i < lattice.active.size(); ++i) {
    out.segment<3>(3 * static_cast<Eigen::Index>(i)) = field[lattice.active[i]];
  }
  return out;
}

Eigen::VectorXd solvePositive(const Eigen::SparseMatrix<double>& h, const Eigen::VectorXd& b) {
  const double stiffest = h.diagonal().maxCoeff();
  for (double shift = 0; shift <= stiffest; shift = std::max(1e-10 * stiffest, 10 * shift)) {
    if (const auto x = solveShifted(h, shift, b)) return *x;
  }
  throw ConvergenceError("the stiffness matrix cannot be made positive definite");
}

StaticsReport minimise(Objective& objective, const FreeDofs& free, const StaticsOptions& options, LinearSolver solver,
                       Field& u_m) {
  StaticsReport report;
  if (free.size() == 0) return report;
  for (; report.iterations <= options.max_iterations; ++report.iterations) {
    objective.freeze(u_m);
    const Eigen::VectorXd gradient = free.of(objective.gradient(u_m));
    const double residual = gradient.lpNorm<Eigen::Infinity>();
    report.residual = residual / std::max(objective.forceScale(u_m), std::numeric_limits<double>::min());
    if (report.residual <= options.tolerance) return report;
    const Eigen::VectorXd step = solver == LinearSolver::kCholesky
                                     ? choleskyStep(objective, free, u_m, gradient)
                                     : conjugateGradientStep(objective, free, u_m, gradient);
    const bool rounding =
        step.lpNorm<Eigen::Infinity>() <= 8 * std::numeric_limits<double>::epsilon() * largestComponent(u_m);
    if (rounding) return report;  // the displacements are at the limit of rounding
    if (!search(objective, free, gradient, step, u_m)) break;
  }
  throw ConvergenceError("no equilibrium after " + std::to_string(report.iterations) +
                         " iterations: residual over largest force " + scientific(report.residual));
}

}  // namespace viscera
