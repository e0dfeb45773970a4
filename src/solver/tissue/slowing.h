// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>

namespace viscera {

/// Share of their velocity that nodes keep per substep in tissue that recovers and obeys a law (physics.md 3).
constexpr float kSlowingKeeps = 0.9f;

/// Returns the largest displacement of such a node in a substep, over the spacing of its body. With it energy falls,
/// and no force carries a node past its neighbours, however much too stiff a strained cell is for the substep.
/// @param setbacks  consecutive roll-backs: a slowed tick that was bad is retried with a smaller displacement
inline float slowedStep(int setbacks) {
  constexpr float kMostStep = 0.05f;
  constexpr int kMostHalvings = 8;
  return std::ldexp(kMostStep, -std::clamp(setbacks - 1, 0, kMostHalvings));
}

}  // namespace viscera
