// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace viscera::nodes {

/// Schedules the calling thread before all ordinary ones (SCHED_FIFO), without the default timer slack of 50 us.
/// @param priority  1..99; 0: ordinary scheduling
/// @returns how it is scheduled: "SCHED_FIFO 20", "ordinary", or what was refused and how to permit it
std::string goFirst(int priority);

}  // namespace viscera::nodes
