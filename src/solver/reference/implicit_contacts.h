// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

#include "solver/reference/implicit_increment.h"
#include "solver/reference/node_contacts.h"

namespace viscera {

/// Probes, obstacles and contacts between nodes in a substep of implicit Euler, by an active-set method. It guesses
/// which contacts are active and which of them stick, finds the equilibrium under the guess by Newton's method, and
/// corrects the guess until it is consistent (physics.md 2, 8).
class ImplicitContacts {
 public:
  /// @param solver  with its obstacles, must outlive this   @param free  [slots] neither held nor fixed
  ImplicitContacts(const ReferenceSolver& solver, const SubstepMotions& motions, std::vector<bool> free);

  /// Solves the substep. @param y_m  positions without any force   @param u_m  in: held nodes at their prescribed
  /// positions; out: the solution
  /// @throws ConvergenceError
  void solve(Increment& increment, const Field& y_m, Field& u_m);
  /// Gives the solver the impulses of probes and obstacles; fast impacts bounce.
  void give(ReferenceSolver& solver, Field& v_next) const;

 private:
  struct Contact {
    uint32_t slot;
    size_t owner;  ///< stylus, or kMaxStyluses + obstacle
    HalfSpace space;
    bool presses = true;
    double pressure_n = 0;
    Vector3d force_n = Vector3d::Zero();
  };
  bool find(const Field& u_m);
  void add(uint32_t slot, size_t owner, const std::optional<HalfSpace>& space);
  void place(Field& u_m) const;
  FreeDofs freeDofs() const;
  std::vector<Increment::Drag> drags() const;
  Field outside(Field predicted_m) const;
  double stiffestNode(const Increment& increment, const Field& u_m) const;
  void balance(Increment& increment, Field& u_m) const;
  bool mend(const Increment& increment, const Field& u_m);
  std::vector<Vector3d> fixedDirections(uint32_t slot) const;

  const ReferenceSolver& solver_;
  const SubstepMotions& motions_;
  std::vector<bool> free_;
  std::vector<Contact> contacts_;
  std::optional<NodeContacts> nodes_;
  double scale_n_ = 0;  ///< largest of the balancing forces [N]
};

}  // namespace viscera
