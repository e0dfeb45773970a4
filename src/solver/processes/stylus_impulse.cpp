// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "solver/processes/stylus_impulse.h"

namespace viscera {

namespace {

void addTo(layout::vec4& sum, const Vector3d& more) {
  sum = {sum.x + static_cast<float>(more.x()), sum.y + static_cast<float>(more.y()),
         sum.z + static_cast<float>(more.z()), sum.w};
}

}  // namespace

void addTo(layout::TickStats& stats, const StylusImpulses& impulses) {
  for (size_t s = 0; s < impulses.size(); ++s) {
    addTo(stats.impulse[s], impulses[s].impulse_ns);
    addTo(stats.angular[s], impulses[s].moment_nms);
    stats.grabbed[s] += impulses[s].nodes;
  }
}

}  // namespace viscera
