// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

namespace viscera::bench {

/// Mean structural similarity of the luma of two images (Wang et al. 2004, their constants and 11 x 11 Gaussian
/// window). 1: equal.
struct Similarity {
  double all = 1;   ///< over the whole image
  double seen = 1;  ///< over pixels at which the second image differs from its first pixel: without the background
};
/// Compares two images. @param rgb, reference  [3 * width * height] RGB8
Similarity similarity(const std::vector<uint8_t>& rgb, const std::vector<uint8_t>& reference, int width, int height);

}  // namespace viscera::bench
