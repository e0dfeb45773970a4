// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "solver/processes/stylus_pull.h"

namespace viscera {

namespace {

void addTo(layout::vec4& sum, const Vector3d& more) {
  sum = {sum.x + static_cast<float>(more.x()), sum.y + static_cast<float>(more.y()),
         sum.z + static_cast<float>(more.z()), sum.w};
}

}  // namespace

void addTo(layout::TickStats& stats, const StylusPulls& pulls) {
  for (size_t s = 0; s < pulls.size(); ++s) {
    addTo(stats.impulse[s], pulls[s].impulse_ns);
    addTo(stats.angular[s], pulls[s].moment_nms);
    stats.grabbed[s] += pulls[s].nodes;
  }
}

}  // namespace viscera
