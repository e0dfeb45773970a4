// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

namespace viscera {

/// Writes an array [height, width] of float32 as NumPy's numpy.load() reads it (format 1.0), replacing the file if
/// there is one. @param values  [width * height], row by row   @throws ImageError
void writeNpy(const std::string& path, int width, int height, const std::vector<float>& values);

}  // namespace viscera
