// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/SparseCholesky>

#include "solver/reference/reference_lattice.h"
#include "solver/reference/statics.h"

namespace viscera {

/// Function of the displacements to be minimised.
class Objective {
 public:
  virtual ~Objective() = default;
  /// Freezes at u the quantities that following calls of value() hold constant.
  virtual void freeze(const Field& /*u_m*/) {}
  virtual double value(const Field& u_m) const = 0;    ///< [J]
  virtual Field gradient(const Field& u_m) const = 0;  ///< [slots] [N]
  virtual Eigen::SparseMatrix<double> hessian(const Field& u_m, ReferenceLattice::Curvature curvature) const = 0;
  virtual double forceScale(const Field& u_m) const = 0;  ///< largest of the balancing forces [N]
};

/// The degrees of freedom that may move, out of all of a lattice.
class FreeDofs {
 public:
  /// @param free  [dofs]
  FreeDofs(const ReferenceLattice& lattice, const std::vector<bool>& free);
  /// @param directions  [dofs x free] orthonormal columns: directions of free motion
  FreeDofs(const ReferenceLattice& lattice, Eigen::SparseMatrix<double> directions)
      : lattice_(lattice), select_(std::move(directions)) {}
  int size() const { return static_cast<int>(select_.cols()); }
  Eigen::VectorXd of(const Field& field) const;
  void add(const Eigen::VectorXd& step, double share, Field& field) const;
  Eigen::SparseMatrix<double> of(const Eigen::SparseMatrix<double>& matrix) const;

 private:
  const ReferenceLattice& lattice_;
  Eigen::SparseMatrix<double> select_;  ///< [dofs x free]
};

Eigen::VectorXd flattened(const ReferenceLattice& lattice, const Field& field);  ///< [dofs]

/// Linear solver for the steps of Newton's method.
enum class LinearSolver {
  kCholesky,           ///< direct, for statics: any condition number
  kConjugateGradients  ///< iterative, for substeps: inertia keeps the condition number low, and a factorisation is slow
};

/// Minimises by Newton's method with line search from u, over the free degrees of freedom. Where the true curvature is
/// not positive it is replaced by a positive one, so every step descends.
/// @throws ConvergenceError
StaticsReport minimise(Objective& objective, const FreeDofs& free, const StaticsOptions& options, LinearSolver solver,
                       Field& u_m);

/// Returns the solution of H x = b with H symmetric, shifted by a multiple of 1 where it is not positive definite.
Eigen::VectorXd solvePositive(const Eigen::SparseMatrix<double>& h, const Eigen::VectorXd& b);

}  // namespace viscera
