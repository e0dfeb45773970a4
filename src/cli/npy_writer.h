// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

namespace viscera {

/// Writes an array [height, width] of float32 in NumPy's format 1.0, which numpy.load() reads. Replaces an existing
/// file.
/// @param values  [width * height], row by row   @throws ImageError
void writeNpy(const std::string& path, int width, int height, const std::vector<float>& values);

}  // namespace viscera
