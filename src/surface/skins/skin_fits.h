// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>

namespace viscera {

/// Size of buffers for surface meshes of tissue that can be cut, over the size of the uncut meshes. Beyond it a tick
/// allocates larger ones.
constexpr size_t kRoomForWounds = 2;

/// Checks that the surface meshes fit into buffers. @param can_be_cut  leave room for wounds
/// @throws GpuError  with that room they have more vertices than this thread's driver can hold in one buffer; names the
/// keys that make them coarser
void requireSkinFits(size_t vertices, bool can_be_cut);

}  // namespace viscera
