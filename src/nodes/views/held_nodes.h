// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <chrono>
#include <vector>

#include "viscera/session/session.h"

namespace viscera::nodes {

/// Positions of the nodes that styluses hold. They move with their tools. The state is read only when the number of
/// held nodes changes, and every half second because nodes slide in jaws: reading it waits for the GPU.
class HeldNodes {
 public:
  /// Sets Frame::held_m. @param frame  frame of the session's last step
  void addTo(Frame& frame, const Session& session);

 private:
  void read(const ToolMotions& tools, const Session& session);

  std::array<std::vector<Vector3d>, layout::kMaxStyluses> held_m_;
  std::array<uint32_t, layout::kMaxStyluses> counts_{};
  std::chrono::steady_clock::time_point read_{};
};

}  // namespace viscera::nodes
