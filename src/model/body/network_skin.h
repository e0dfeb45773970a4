// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "viscera/model/body/skin.h"
#include "viscera/model/body/spring_network.h"

namespace viscera {

/// Returns the one-to-one surface mesh of a network (EGVE 3.2): a vertex per node of its surface, in the order of their
/// slots, with the weights (1, 0, 0) of its node. Its mesh has one part.
/// @param can_be_cut  also prepares where triangles split: the edges of the surface that are springs. Where two springs
///                    join the same two nodes, the first represents the edge: a blade crosses both.
Skin bindNetworkSkin(const SpringNetwork& network, bool can_be_cut);

}  // namespace viscera
