// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>

#include "viscera/api.h"
#include "viscera/math/types.h"

namespace VISCERA_PUBLIC viscera {

/// Fibre of an attachment (docs/physics.md 17).
struct FibreState {
  std::array<uint32_t, 2> nodes{};     ///< slots of the model: the node of each body that carries most of its end
  Vector3d rest_m = Vector3d::Zero();  ///< position of both ends at rest, tissue frame
  double area_m2 = 0;
  bool whole = true;  ///< it still pulls
};

}  // namespace viscera
