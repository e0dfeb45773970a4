// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/SparseCholesky>
#include <memory>
#include <vector>

#include "solver/multigrid/levels/coarse_level.h"
#include "solver/multigrid/levels/coarsening.h"

namespace viscera::multigrid {

/// The levels below the finest, built at rest for a stage and then kept: a preconditioner that stays good while the
/// tissue moves and, less so, where it is cut. Its nodes are those of the level that it was made of.
class Hierarchy {
 public:
  /// @param parallel  its cycles work on; it is built on the level's
  Hierarchy(const FineLevel& level, const Parallel& parallel);

  size_t levels() const { return levels_.size() + 1; }  ///< the finest too
  const CoarseLevel& coarse(size_t level) const { return *levels_[level]; }
  size_t elements() const { return elements_; }
  const Transfer& transfer(size_t level) const {
    return transfers_[level];
  }  ///< from coarse(level) to the one above it

  /// Of the matrix of the coarsest level, three numbers a node. There is one below the finest.
  Eigen::MatrixXd coarsestInverse() const;

  /// Vectors that a cycle overwrites.
  struct Work {
    Vectors r, d, e;
  };
  /// z = one V-cycle of A z = r from 0: Chebyshev of degree 2 on blocks of 3x3 before and after. Symmetric and
  /// positive. @param r  0 where not free   @return r . z
  double cycle(const FineLevel& level, float largest, const Vectors& r, Work& work, Vectors& z) const;
  /// z = by D^-1 r + P A1^-1 P^T r: a smoother's step and the coarse levels side by side. No product on the finest
  /// level, and about twice the iterations. @return r . z
  double cycleSideBySide(const FineLevel& level, float largest, const Vectors& r, Work& work, Vectors& z) const;

 private:
  void cycleAt(size_t level) const;
  void solveCoarsest() const;
  void restrictFine(const FineLevel& level, const Vectors& r) const;
  void addToFine(const FineLevel& level, Vectors& correction) const;

  std::vector<std::unique_ptr<CoarseLevel>> levels_;
  std::vector<Transfer> transfers_;  ///< [levels_] of the level to the one above it
  std::unique_ptr<Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>>> coarsest_;
  const Parallel& parallel_;
  size_t elements_ = 0;
};

/// Coefficients of Chebyshev's iteration of degree 2 over [largest/6, largest]: d = b D^-1 r, then d = a d + b2 D^-1 r.
struct Chebyshev {
  explicit Chebyshev(float largest);
  float first, again, second;  ///< b; a, b2
};

/// Largest eigenvalue of D^-1 A by power iteration, enlarged, as the smoother needs it.
float largestOf(const FineLevel& level);

}  // namespace viscera::multigrid
