// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
// Friction of the sides of a blade on the tissue.
#include "solver/processes/blade/blade_edge.h"

namespace viscera {

/// Applies friction. It drags tissue along, also in the blade's own wound and in any direction, up to a limit.
void BladeEdge::rubOne(size_t i, double dt_s) {
  Push& push = pushes_[i];
  const double cap_n_s = friction_n_per_m_ * push.length_m * dt_s, mobility = mobilities_[i * fronts_.size() + i];
  if (!(cap_n_s > 0) || !(mobility > 0)) return;
  Vector3d next = push.rub + (push.edge_velocity - push.velocity) / mobility;
  const double size = next.norm();
  if (size > cap_n_s) next *= cap_n_s / size;
  const Vector3d impulse = push.impulse - push.rub + next;
  push.rub = next;
  give(i, impulse);
}

/// Replaces the sample's impulse and updates the velocities at the other samples.
void BladeEdge::give(size_t i, const Vector3d& impulse) {
  const Vector3d more = impulse - pushes_[i].impulse;
  pushes_[i].impulse = impulse;
  for (size_t j = 0; j < fronts_.size(); ++j) pushes_[j].velocity += mobilities_[i * fronts_.size() + j] * more;
}

}  // namespace viscera
