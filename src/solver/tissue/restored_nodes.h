// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "math/archive.h"
#include "viscera/layout/nodes.h"

namespace viscera {

/// Checks the node bits that a saved state holds against those of the whole tissue: a spring or a body that the tissue
/// does not have would be looked up beyond the end of the arrays. Springs may be weaker or cut, cells cut, nodes held.
/// @param whole, restored  [slots]
/// @param bodies  [bodies] as given to the backend
/// @throws Error  names the archive's section, the node and what differs
void requireNodesOf(const std::vector<layout::NodeBits>& whole, const std::vector<layout::BodyParams>& bodies,
                    const std::vector<layout::NodeBits>& restored, const Archive& archive);

}  // namespace viscera
