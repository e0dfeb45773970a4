// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>

#include "viscera/surface/visible_mesh.h"

namespace viscera {

namespace {

constexpr float kOne = 511;  // largest signed 10-bit number

}  // namespace

uint32_t packNormal(const Vector3f& normal) {
  uint32_t packed = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const float fraction = std::clamp(normal[axis], -1.0f, 1.0f);
    const int q = static_cast<int>(std::floor(fraction * kOne + 0.5f));
    packed |= (static_cast<uint32_t>(q) & 1023u) << (10 * axis);
  }
  return packed;
}

Vector3f unpackNormal(uint32_t packed) {
  Vector3f normal;
  for (int axis = 0; axis < 3; ++axis) {
    const int bits = static_cast<int>((packed >> (10 * axis)) & 1023u);
    normal[axis] = static_cast<float>(bits < 512 ? bits : bits - 1024) / kOne;
  }
  return normal;
}

}  // namespace viscera
