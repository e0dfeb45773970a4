// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include "viscera/model/body/spring_network.h"

namespace viscera {

/// Nodes (slots with mass) in the order of a Morton curve through their rest positions. Against reverse Cuthill-McKee,
/// measured on a cloth of 256 x 256 and a ball of 10000 nodes: 79 and 75 % of the springs stay within a brick, not 34
/// and 34, and bricks are 16 and 19 springs across, not 97 and 54, so that they sleep and are drawn one by one;
/// neighbours are 173 and 120 slots apart on average, not 157 and 92.
std::vector<uint32_t> mortonOrder(const SpringNetwork& network);

}  // namespace viscera
