// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "viscera/api.h"
#include "viscera/math/types.h"

namespace VISCERA_PUBLIC viscera {

/// A vector shown in an image.
struct Arrow {
  enum class Kind { kForce, kWind };
  Kind kind = Kind::kForce;
  Vector3d from_m = Vector3d::Zero();   ///< tissue frame
  Vector3d along_m = Vector3d::Zero();  ///< from the start to the tip

  bool operator==(const Arrow& other) const {
    return kind == other.kind && from_m == other.from_m && along_m == other.along_m;
  }
};

}  // namespace viscera
