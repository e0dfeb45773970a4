// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>

namespace viscera {

/// Times the vertices and triangles of the skins that buffers hold where tissue can be cut: beyond it a tick makes
/// larger ones.
constexpr size_t kRoomForWounds = 2;

/// @param can_be_cut  the skins have room for wounds
/// @throws GpuError  the skins, with that room, have more vertices than this thread's driver can hold in one buffer;
/// names what makes them coarser
void requireSkinFits(size_t vertices, bool can_be_cut);

}  // namespace viscera
