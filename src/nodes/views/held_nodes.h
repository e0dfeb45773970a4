// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <chrono>
#include <vector>

#include "viscera/session/session.h"

namespace viscera::nodes {

/// Where the nodes are that styluses hold. They go along with their tools, so that the state, which a GPU must be
/// waited for, is read only when another number of them is held, and every half second, as what slides in jaws.
class HeldNodes {
 public:
  /// @param frame  of the session's last step; gets Frame::held_m
  void addTo(Frame& frame, const Session& session);

 private:
  void read(const ToolMotions& tools, const Session& session);

  std::array<std::vector<Vector3d>, layout::kMaxStyluses> held_m_;
  std::array<uint32_t, layout::kMaxStyluses> counts_{};
  std::chrono::steady_clock::time_point read_{};
};

}  // namespace viscera::nodes
