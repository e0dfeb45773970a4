// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "haptics/force_loop.h"
#include "nodes/input/stylus_mailbox.h"

namespace viscera {
struct Scene;
}

namespace viscera::nodes {

/// The private parameters of the simulator that control forces between two ticks.
struct HapticOptions {
  double rate_hz = 1000;   ///< rate of force updates [Hz]; 0: one force per tick
  double delay_s = 0.002;  ///< delay of a device [s]: from its measurement of a pose to the force that answers it
  int priority = 20;       ///< SCHED_FIFO priority of the force thread; 0: ordinary scheduling
};

/// Returns the options of each stylus of a scene, combined with its device's profile. @param mailboxes  [styluses]
std::vector<ForceLoop::Stylus> forceStyluses(const HapticOptions& options, const Scene& scene,
                                             const std::vector<const StylusMailbox*>& mailboxes);

}  // namespace viscera::nodes
