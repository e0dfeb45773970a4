// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

namespace viscera::bench {

/// Mean structural similarity of two pictures (Wang et al. 2004, their constants and 11 x 11 Gaussian window), of their
/// luma. 1: the same.
struct Similarity {
  double all = 1;   ///< over the whole picture
  double seen = 1;  ///< over pixels where the second one differs from its first pixel: without the background
};
/// @param rgb, reference  [3 * width * height] RGB8
Similarity similarity(const std::vector<uint8_t>& rgb, const std::vector<uint8_t>& reference, int width, int height);

}  // namespace viscera::bench
