// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "haptics/force_loop.h"
#include "nodes/hands/stylus_mailbox.h"

namespace viscera {
struct Scene;
}

namespace viscera::nodes {

/// What the private parameters of the simulator say of forces between two ticks.
struct HapticOptions {
  double rate_hz = 1000;   ///< 0: forces once per tick
  double delay_s = 0.002;  ///< of a device: from a pose measured there to the force that answers it
  int priority = 20;       ///< of the thread that answers, SCHED_FIFO; 0: as every other thread
};

/// The same for each stylus of a scene, with what its device says. @param mailboxes  of the styluses, in order
std::vector<ForceLoop::Stylus> forceStyluses(const HapticOptions& options, const Scene& scene,
                                             const std::vector<const StylusMailbox*>& mailboxes);

}  // namespace viscera::nodes
