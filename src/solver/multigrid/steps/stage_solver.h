// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "solver/multigrid/levels/built_levels.h"
#include "viscera/solver/solver.h"

namespace viscera::multigrid {

constexpr float kWayOfDifferences = 3e-3f;  ///< spacings: how far forces are asked for their change

/// What is added to exact tangents where these would not be positive.
class Stiffening {
 public:
  virtual ~Stiffening() = default;
  virtual void addTo(const Vectors& p, Vectors& q) const = 0;
  /// The tangent was not positive with it.
  virtual void sagged() = 0;
};

/// When to stop.
struct Rule {
  /// Of conjugate gradients: residual over the first one.
  double tolerance = 0.1;
  /// They end also by what they gain: when the last one, as often as there were any, lowers the energy by less than
  /// this share of what all did (S. G. Nash, A. Sofer, Oper. Res. Lett. 9, 1990). Residuals of nearly incompressible
  /// tissue say little of what is wrong with it.
  double gain = 0.02;
  int least = 2, most = 15;  ///< iterations
  double again = 0.5;        ///< another Newton step while it left more of the residual
  int newton = 3;            ///< steps at most
  /// Products with the change of forces itself rather than with the positive tangent, which preconditions only: more
  /// iterations in a system, and each dearer, but Newton's method meets 1e-4 in a few steps.
  bool exact = false;
  Stiffening* stiffening = nullptr;  ///< of exact ones
  bool side_by_side = false;         ///< preconditions by Hierarchy::cycleSideBySide()
  double enough_n = 0;               ///< residual that need not be improved on
  bool tame = true;                  ///< steps carry no node far from those around it

  /// After a system's k-th iteration. @param lowers_j  the energy, by itself   @param lowered_j  by all of them
  /// @param left_n, first_n  residual of the system now and at first
  bool ends(int k, double lowers_j, double lowered_j, double left_n, double first_n) const {
    const bool gains = k * lowers_j >= gain * lowered_j;
    return k >= least && (left_n <= enough_n || !gains || left_n <= tolerance * first_n);
  }
};

/// Energy of all that can move [J].
struct Energy {
  double kinetic_j = 0;
  double sum_j = 0;  ///< kinetic and elastic less the work of gravity and load
};

/// Of conjugate gradients.
struct Iteration {
  bool done = false;    ///< else nothing was: the residual is 0, or a direction is not downhill
  double lowers_j = 0;  ///< the energy, by itself
  double left_n = 0;    ///< residual of the system
};

/// One system: iterate(first) until the rule says so. @param norm_n  residual at first   @return iterations
template <class Iterate>
int solveSystem(const Rule& rule, double norm_n, const Iterate& iterate) {
  double lowered_j = 0;
  for (int k = 0; k < rule.most;) {
    const Iteration each = iterate(k == 0);
    if (!each.done) return k;
    ++k;
    lowered_j += each.lowers_j;
    if (rule.ends(k, each.lowers_j, lowered_j, each.left_n, norm_n)) return k;
  }
  return rule.most;
}

/// Residuals and systems of Newton's method for the increment du of a stage (physics.md 2),
///   m a0 (dy - du) + m g - m gamma v + F(u + du) + dashpots(v) = 0,   v = rate (du - dw),
/// Systems are solved by conjugate gradients, with a V-cycle as preconditioner.
class StageSolver {
 public:
  StageSolver(const Model& model, const CpuLattice& lattice, const Parallel& parallel);

  /// Reads springs and cells again: they were cut. The hierarchy stays until it is rebuilt.
  void refresh();
  /// The hierarchy is made for this stage, if it is not good enough for it as it is.
  void begin(const Stage& stage);
  /// Begins to build the hierarchy of the springs as they are now, on a thread of its own; takeRebuilt() waits for it
  /// and takes it.
  void rebuildAside();
  void takeRebuilt();
  void persist(Archive& archive, CpuLattice& lattice) { built_.persist(archive, level, lattice); }

  /// Residual of an increment [N], 0 where not free; linearises there. @return its norm
  double residual(const Vectors& increment);
  /// Its two halves: residual of nodes that can move, held or not, and then without those that are held. @return its
  /// norm
  /// @param tangent  linearises there: else forces alone
  void evaluate(const Vectors& increment, bool tangent);
  double masked();
  Energy energy(const Vectors& displacement_m, const Vectors& velocity_m_per_s, double elastic_j) const;
  /// One system: x of A x = residual(increment), which was asked for last. @return iterations
  int solveLinear(const Vectors& increment, const Rule& rule, double norm);
  Iteration iterate(const Vectors& increment, const Rule& rule, bool first);  ///< of it
  void tame();  ///< the solution, where it would carry a node away from those around it

  FineLevel level;
  Vectors start;   ///< u [m]
  Vectors wanted;  ///< dy [m]
  Vectors offset;  ///< dw [m]
  Vectors load;    ///< N beside gravity; 0 unless set
  Vector3f gravity = Vector3f::Zero();
  Stage stage;
  Vectors displacement;  ///< u + du and rate (du - dw) where residual() was
  Vectors velocity;
  double elastic_j = 0;  ///< there
  const Vectors& solution() const { return s_; }
  Vectors& lacking() { return r_; }  ///< residual, until a system is solved
  const Hierarchy* hierarchy() const { return levels_.hierarchy.get(); }
  double noise_n = 0;  ///< norm of the rounding of forces in float32, there

 private:
  float farthest(const Vectors& x) const;
  uint32_t mayBeFar(const Block& block) const;
  Vector3f tamedStep(uint32_t node) const;
  void multiply(const Vectors& increment, const Vectors& p, Vectors& q, const Stiffening* stiffening);

  BuiltLevels built_;
  BuiltLevels::Built levels_;    ///< that are in use
  double stiffest_n_per_m_ = 0;  ///< sum of a node's springs
  Vectors r_, s_, p_, q_, z_;
  double rz_ = 0;  ///< of the last iteration
  Hierarchy::Work work_;
  Vectors force_;  ///< where the residual was, for exact products
};

}  // namespace viscera::multigrid
