// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include "layout.h"

namespace viscera {

/// Where the state of all nodes lives: what surface/ and render/ need to know of a solver. Buffer names are OpenGL's.
struct StateView {
  uint32_t displacement = 0;  ///< vec4[slots], xyz m from rest
  uint32_t velocity = 0;      ///< vec4[slots], xyz m/s
  uint32_t nodes = 0;         ///< NodeBits[slots]
  uint32_t bricks = 0;        ///< Brick[bricks]
  uint32_t bodies = 0;        ///< BodyParams[bodies]
  uint64_t cut_revision = 0;  ///< grows whenever springs may have been cut since the last step
};

/// Copy of the state on the host, for hashing, saving and tests.
struct HostState {
  std::vector<layout::vec4> displacement_m;    ///< [slots]
  std::vector<layout::vec4> velocity_m_per_s;  ///< [slots]
  std::vector<layout::NodeBits> nodes;         ///< [slots]
};

}  // namespace viscera
