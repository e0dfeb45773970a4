// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
// clang-format off
// What is measured once a tick.
#ifndef VISCERA_LAYOUT_TICK_STATS_H
#define VISCERA_LAYOUT_TICK_STATS_H
#include "viscera/layout/limits.h"
#include "viscera/layout/types.h"

#ifdef __cplusplus
namespace viscera::layout {
#endif

const float kCollapsed = 0.3f;  // of a spring's rest length

// What one tick leaves behind, read back as one small block.
struct TickStats {
  vec4 impulse[2];        // xyz momentum given to the nodes by each stylus over the tick [N s]
  vec4 angular[2];        // xyz its moment about the stylus tip at the end of the tick [N m s]
  uint springs_cut;       // since the last reset
  uint nonfinite;         // nodes with a non-finite displacement or velocity
  uint max_stretch_bits;  // float bits of max |L - l0| / l0 over springs
  uint max_speed_bits;    // float bits of max |v| [m/s]
  uint grabbed[2];        // nodes held by each stylus
  uint touched[2];        // nodes that got an impulse from each stylus in the tick
  uint collapsed;         // springs shorter than kCollapsed of their rest length
  uint max_rate_bits;     // float bits of max over free nodes of (2 sum k + volume) / m [1/s2]: dt_safe = 2 / sqrt of it
  float kinetic_j;
  float elastic_j;        // springs and volumes
  uint inverted;          // whole cells turned inside out
  uint crowded;           // nodes that no contact acts on, as too many lie in one place (collision_place.comp)
  uint max_stiffening_bits;  // float bits of the largest stiffening() of cells of a hyperelastic law (law.glsl)
  uint pad;
  vec4 obstacle_impulse[kMaxObstacles];  // xyz momentum given to the nodes by each obstacle over the tick [N s]; w nodes touched
  vec4 obstacle_angular[kMaxObstacles];  // xyz its moment about the obstacle's place at the end of the tick [N m s]
};

#ifdef __cplusplus
}  // namespace viscera::layout
#endif
#endif
