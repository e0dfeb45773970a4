// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <string>

namespace viscera::gpu {

/// Returns the number of storage blocks that a compute shader's source declares with its features. All of them count
/// against the driver's limit, used or not: their layout is std430.
/// @param source  as of shaderSource(): only the #if lines that our sources have, `defined` with && or with ||
size_t declaredStorageBlocks(const std::string& source);

}  // namespace viscera::gpu
