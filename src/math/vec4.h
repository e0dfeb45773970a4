// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "viscera/layout/types.h"
#include "viscera/math/types.h"

namespace viscera {

/// Returns the first three components of `v` in double precision.
inline Vector3d xyz(const layout::vec4& v) {
  return {v.x, v.y, v.z};
}
/// Returns `v` in single precision, with 0 as the fourth component.
inline layout::vec4 rounded(const Vector3d& v) {
  return {static_cast<float>(v.x()), static_cast<float>(v.y()), static_cast<float>(v.z()), 0};
}

}  // namespace viscera
