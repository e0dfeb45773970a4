// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>

namespace viscera {

/// Operations of a blade in every substep on runs of eight nodes (BladeNodes), with the widest vectors of the
/// processor. Each of the eight lanes is summed separately, so the rounding is the same on all processors.

/// Nodes with weights.
struct WeightedRuns {
  const uint32_t* runs;  ///< [count] eighths of indices into planes
  const float* weights;  ///< [8 * count]
  size_t count;
};
/// Sums values with weights. @param planes  planes of values   @param out  weighted sum of each plane
void sumRuns(const WeightedRuns& runs, const float* const (&planes)[6], float (&out)[6]);
/// Adds weights times parts to three planes.
void addToRuns(const WeightedRuns& runs, const float (&parts)[3], float* const (&planes)[3]);

/// Changes of velocities, with the arrays of the CPU backend.
struct PushedRuns {
  const uint32_t* slots;  ///< [count] first slots of runs of eight
  size_t count;
  const float* dv_m_per_s[3];  ///< [8 * count]
  float dt_s;
  const float *mobility, *mass_kg;  ///< [slots]; mobility 0: the node does not move
  float *v, *u, *pushed;            ///< velocities, displacements, momenta to change, [3 * slots] by bricks
  uint8_t* bricks;                  ///< [bricks] set to 1 where a node moves
};
void pushRuns(const PushedRuns& runs);

}  // namespace viscera
