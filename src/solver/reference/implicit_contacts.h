// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

#include "solver/reference/implicit_increment.h"
#include "solver/reference/node_contacts.h"

namespace viscera {

/// Probes, obstacles and contacts between nodes in a substep of implicit Euler, by an active set: which contacts press
/// and which of them stick is guessed, the equilibrium is found under that by Newton's method, and the guess is mended
/// until it fits (physics.md 2, 8).
class ImplicitContacts {
 public:
  /// @param solver  with its obstacles, must outlive this   @param free  [slots] neither held nor at rest
  ImplicitContacts(const ReferenceSolver& solver, const SubstepMotions& motions, std::vector<bool> free);

  /// @param y_m  where no force would bring the nodes   @param u_m  held nodes where they will be; becomes the solution
  /// @throws ConvergenceError
  void solve(Increment& increment, const Field& y_m, Field& u_m);
  /// Tells the solver what probes and obstacles gave; fast arrivals bounce.
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
  double scale_n_ = 0;  ///< largest of the forces that balance
};

}  // namespace viscera
