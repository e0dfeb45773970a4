// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>

#include "viscera/model/shape/surface_detail.h"

namespace viscera {

/// Longest side of an accepted image [px]: what OpenGL 4.5 guarantees for textures.
constexpr int kMostTexturePixels = 16384;

/// Decodes a PNG or JPEG file in memory, recognised by its first bytes.
/// @throws MeshError  another format, corrupt or cut short, larger than kMostTexturePixels; without the file's name
TextureImage decodeImage(const uint8_t* bytes, size_t count);

}  // namespace viscera
