// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>

namespace viscera {

/// Share of their velocity that a substep leaves to the nodes of tissue that recovers and obeys a law (physics.md 3).
constexpr float kSlowingKeeps = 0.9f;

/// Returns how far such a node goes in a substep at most, over the spacing of its body. Energy falls so, and no force,
/// however much too stiff a strained cell is for the substep, carries a node past its neighbours.
/// @param setbacks  roll-backs in a row: a tick that was slowed and is bad all the same is not tried again as it was
inline float slowedWay(int setbacks) {
  constexpr float kMostWay = 0.05f;
  constexpr int kMostHalvings = 8;
  return std::ldexp(kMostWay, -std::clamp(setbacks - 1, 0, kMostHalvings));
}

}  // namespace viscera
