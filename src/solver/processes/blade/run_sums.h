// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>

namespace viscera {

/// What a blade does in every substep with runs of eight nodes (BladeNodes), by the widest vectors that the processor
/// has. Each of the eight places is summed by itself, so that all processors round alike.

/// Nodes with weights.
struct WeightedRuns {
  const uint32_t* runs;  ///< [count] eighths of places in planes
  const float* weights;  ///< [8 * count]
  size_t count;
};
/// @param planes  of values   @param out  the weighted sum of each
void sumRuns(const WeightedRuns& runs, const float* const (&planes)[6], float (&out)[6]);
/// Adds weights times parts to three planes.
void addToRuns(const WeightedRuns& runs, const float (&parts)[3], float* const (&planes)[3]);

/// Changes of velocities, where nodes lie in the arrays of the CPU backend.
struct PushedRuns {
  const uint32_t* slots;  ///< [count] the first of eight
  size_t count;
  const float* dv_m_per_s[3];  ///< [8 * count]
  float dt_s;
  const float *mobility, *mass_kg;  ///< [slots]; mobility 0: it does not move
  float *v, *u, *pushed;            ///< [3 * slots] by bricks; velocities, displacements, momenta: changed
  uint8_t* bricks;                  ///< [bricks] 1 is written where a node moves
};
void pushRuns(const PushedRuns& runs);

}  // namespace viscera
