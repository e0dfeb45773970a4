// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "solver/reference/implicit_increment.h"

namespace viscera {

/// Contacts between nodes in a substep of implicit Euler (physics.md 2, 8): two that may touch come no nearer along the
/// normal that they have at its start than the distance that they keep. Found once, where the first iterate leads;
/// solved for by augmented Lagrangians.
class NodeContacts {
 public:
  /// @param solver  with its surroundings, must outlive this   @param predicted_m  displacements of the first iterate
  NodeContacts(const ReferenceSolver& solver, const Field& predicted_m);

  bool empty() const { return pairs_.empty(); }
  /// @param scale_n_per_m  of what resists a push: how stiff a contact is that has no force yet
  void tell(Increment& increment, double scale_n_per_m) const;
  /// Friction under the pressures of the guess, behind what is in `drags`.
  void addDrags(std::vector<Increment::Drag>& drags) const;
  /// Takes the pressures of a solution for the next guess. @return whether one changed by more than the tolerance
  bool mend(const Increment& increment, const Field& u_m, double tolerance_n);
  /// What came fast enough bounces. @param free  [slots] of nodes that are not prescribed
  void bounce(const std::vector<bool>& free, Field& v_next) const;

 private:
  const ReferenceSolver& solver_;
  double friction_ = 0, restitution_ = 0;
  std::vector<Increment::Pair> pairs_;
};

}  // namespace viscera
