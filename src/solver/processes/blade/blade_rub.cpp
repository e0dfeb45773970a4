// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
// What the walls of a blade do to the tissue that it goes through.
#include "solver/processes/blade/blade_edge.h"

namespace viscera {

/// Friction takes the tissue along, in its wound too and whichever way the blade goes, up to a limit.
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

/// In place of what the sample gave; the tissue of the others feels it too.
void BladeEdge::give(size_t i, const Vector3d& impulse) {
  const Vector3d more = impulse - pushes_[i].impulse;
  pushes_[i].impulse = impulse;
  for (size_t j = 0; j < fronts_.size(); ++j) pushes_[j].velocity += mobilities_[i * fronts_.size() + j] * more;
}

}  // namespace viscera
