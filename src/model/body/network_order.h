// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include "viscera/model/body/spring_network.h"

namespace viscera {

/// Returns the nodes (slots with mass) in the order of a Morton curve through their rest positions. Compared with
/// reverse Cuthill-McKee on a cloth of 256 x 256 and a ball of 10000 nodes, 79 and 75 % of the springs stay within a
/// brick, instead of 34 and 34. Bricks are 16 and 19 springs across, instead of 97 and 54, so that they sleep and are
/// drawn one by one. Neighbours are 173 and 120 slots apart on average, instead of 157 and 92.
std::vector<uint32_t> mortonOrder(const SpringNetwork& network);

}  // namespace viscera
