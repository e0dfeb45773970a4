// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "nodes/views/held_nodes.h"

#include <algorithm>

#include "viscera/solver/solver.h"

namespace viscera::nodes {
namespace {

constexpr std::chrono::milliseconds kReadAgain{500};

}  // namespace

void HeldNodes::addTo(Frame& frame, const Session& session) {
  std::array<uint32_t, layout::kMaxStyluses> counts;
  std::copy_n(frame.stats.grabbed, counts.size(), counts.begin());
  const auto now = std::chrono::steady_clock::now();
  const bool any = std::any_of(counts.begin(), counts.end(), [](uint32_t count) { return count > 0; });
  if (!any) {
    held_m_ = {};
  } else if (counts != counts_ || now >= read_ + kReadAgain) {
    read(frame.tools, session);
    read_ = now;
  }
  counts_ = counts;
  frame.held_m = held_m_;
}

void HeldNodes::read(const ToolMotions& tools, const Session& session) {
  held_m_ = {};
  const HostState state = session.solver().readState();
  const Model& model = session.model();
  for (size_t b = 0; b < model.bodies.size(); ++b) {
    const uint32_t first = model.slotOffset(b), end = model.slotOffset(b + 1);
    for (uint32_t slot = first; slot < end; ++slot) {
      const uint32_t held_by = (state.nodes[slot].lo & layout::kGrabMask) >> layout::kGrabShift;
      if (held_by == 0) continue;
      const layout::vec4& u_m = state.displacement_m[slot];
      const Vector3d position_m = restPosition(model.bodies[b], slot - first) + Vector3d(u_m.x, u_m.y, u_m.z);
      held_m_[held_by - 1].push_back(tools[held_by - 1].to.inverse() * position_m);
    }
  }
}

}  // namespace viscera::nodes
