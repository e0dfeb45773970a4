// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace viscera::nodes {

/// Asks that the calling thread goes before all ordinary ones (SCHED_FIFO), and wakes when it wants to and not 50 us
/// later. @param priority  1..99; 0: it stays ordinary
/// @returns how it is scheduled: "SCHED_FIFO 20", "ordinary", or what was refused and how it is permitted
std::string goFirst(int priority);

}  // namespace viscera::nodes
