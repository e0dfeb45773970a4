// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "solver/reference/implicit_increment.h"

namespace viscera {

/// Contacts between nodes in a substep of implicit Euler (physics.md 2, 8). Two nodes that may touch come no nearer
/// than their distance of contact, along the normal at the start of the substep. Pairs are found once, at the first
/// iterate, and solved by augmented Lagrangians.
class NodeContacts {
 public:
  /// @param solver  with its environment, must outlive this   @param predicted_m  displacements of the first iterate
  NodeContacts(const ReferenceSolver& solver, const Field& predicted_m);

  bool empty() const { return pairs_.empty(); }
  /// Passes the pairs to the increment. @param scale_n_per_m  stiffness against a push; sets the penalty stiffness of
  /// contacts
  void tell(Increment& increment, double scale_n_per_m) const;
  /// Appends to `drags` the friction under the pressures of the guess.
  void addDrags(std::vector<Increment::Drag>& drags) const;
  /// Takes the pressures of a solution as the next guess. @return whether one changed by more than the tolerance
  bool mend(const Increment& increment, const Field& u_m, double tolerance_n);
  /// Lets fast impacts bounce. @param free  [slots] nodes that are not prescribed
  void bounce(const std::vector<bool>& free, Field& v_next) const;

 private:
  const ReferenceSolver& solver_;
  double friction_ = 0, restitution_ = 0;
  std::vector<Increment::Pair> pairs_;
};

}  // namespace viscera
