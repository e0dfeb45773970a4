// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
// Implicit Euler, solved to convergence: m (1 + gamma dt)/dt^2 (u+ - y) = F(u+) with
// y = u + (dt v + dt^2 g)/(1 + gamma dt) and dashpots c n n^T ((u+_j - u+_i) - (u_j - u_i))/dt, n of u+.
#include "solver/reference/implicit_contacts.h"
#include "solver/reference/implicit_increment.h"

namespace viscera {

/// Held nodes are prescribed at their positions at the end of the substep, and nodes that would end in a probe or an
/// obstacle stay outside; the solution includes both. The residual of a node's forces and inertia there is the force of
/// the tool or obstacle that holds or touches it.
void ReferenceSolver::implicitEuler(Field& u_next, Field& v_next) {
  Field y = u_m;
  std::vector<bool> free(slots(), false);
  for (uint32_t slot : active) {
    if (rests(slot)) continue;
    y[slot] += dt_s_ * (v_m_per_s[slot] + dt_s_ * gravity_) / (1 + mass_damping_per_s(slot) * dt_s_);
    free[slot] = heldBy(slot) == 0;
    if (const uint32_t held_by = heldBy(slot)) u_next[slot] = heldDisplacement(motions_[held_by - 1], slot);
  }
  Increment increment(*this, y);
  ImplicitContacts contacts(*this, motions_, free);
  contacts.solve(increment, y, u_next);
  for (uint32_t slot : active) {
    if (!rests(slot)) v_next[slot] = (u_next[slot] - u_m[slot]) / dt_s_;
  }
  const Field unbalanced = increment.gradient(u_next);
  for (uint32_t slot : active) {
    if (const uint32_t held_by = heldBy(slot)) impulse_n_s[held_by - 1] += dt_s_ * unbalanced[slot];
  }
  contacts.give(*this, v_next);
}

}  // namespace viscera
