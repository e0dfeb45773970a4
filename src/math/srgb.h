// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace viscera {

// Conversion of one channel of a colour, 0..1, between sRGB (IEC 61966-2-1), as files and users give it, and linear
// light.

inline double linearFromSrgb(double c) {
  return c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4);
}
/// Returns the sRGB byte of a linear value. @param linear  clamped to 0..1
inline uint8_t srgbByte(double linear) {
  const double c = linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1 / 2.4) - 0.055;
  return static_cast<uint8_t>(std::lround(255 * std::clamp(c, 0.0, 1.0)));
}

}  // namespace viscera
