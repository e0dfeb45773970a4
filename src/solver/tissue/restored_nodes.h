// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "math/archive.h"
#include "viscera/layout/nodes.h"

namespace viscera {

/// Checks the node bits of a saved state against those of the whole tissue. A spring or body that the tissue does not
/// have would index beyond the end of the arrays. Springs may be weaker or cut, cells cut, nodes held.
/// @param whole, restored  [slots]
/// @param bodies  [bodies] as given to the backend
/// @throws Error  names the archive's section, the node and the difference
void requireNodesOf(const std::vector<layout::NodeBits>& whole, const std::vector<layout::BodyParams>& bodies,
                    const std::vector<layout::NodeBits>& restored, const Archive& archive);

}  // namespace viscera
