// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "math/out_file.h"
#include "viscera/math/error.h"

namespace viscera {

/// Error for an image file that cannot be written. Names the file and the system's error.
struct ImageError : Error {
  using Error::Error;
};

/// Writes a file atomically (math/out_file.h). @throws ImageError
void writeImageFile(const std::string& path, FileKind kind, std::string_view bytes);

/// Writes an 8-bit sRGB image. Replaces an existing file.
/// @param rgb  [3 * width * height], rows from the top
/// @throws ImageError
void writePng(const std::string& path, int width, int height, const std::vector<uint8_t>& rgb);

/// Writes one value per pixel as grey. @param values  [width * height], rows from the top
void writeGreyPng(const std::string& path, int width, int height, const std::vector<uint8_t>& values);

}  // namespace viscera
