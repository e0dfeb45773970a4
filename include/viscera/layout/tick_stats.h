// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
// clang-format off
// Measurements of one tick.
#ifndef VISCERA_LAYOUT_TICK_STATS_H
#define VISCERA_LAYOUT_TICK_STATS_H
#include "viscera/layout/limits.h"
#include "viscera/layout/types.h"

#ifdef __cplusplus
namespace VISCERA_PUBLIC viscera { namespace layout {
#endif

const float kCollapsed = 0.3f;  // share of its rest length below which a spring counts as collapsed

// Measurements that one tick leaves behind, read back as one small block.
struct TickStats {
  vec4 impulse[2];  // xyz momentum that each stylus gave the nodes over the tick [N s]
  vec4 angular[2];  // xyz moment of that momentum about the stylus tip at the end of the tick [N m s]
  uint springs_cut;  // number of springs cut since the last reset
  uint nonfinite;  // number of nodes with a non-finite displacement or velocity
  uint max_stretch_bits;  // float bits of max |L - l0| / l0 over springs
  uint max_speed_bits;    // float bits of max |v| [m/s]
  uint grabbed[2];  // number of nodes that each stylus holds
  uint touched[2];  // number of nodes that got an impulse from each stylus in the tick
  uint collapsed;  // number of springs shorter than kCollapsed of their rest length
  uint max_rate_bits;     // float bits of max over free nodes of (2 sum k + volume) / m [1/s2]: dt_safe = 2 / sqrt of it
  float kinetic_j;
  float elastic_j;  // elastic energy of springs and volumes [J]
  uint inverted;  // number of whole cells that are inverted
  uint crowded;  // number of nodes without contact forces, because too many nodes are in one place (collision_place.comp)
  uint max_stiffening_bits;  // float bits of the largest stiffening() over cells of a hyperelastic law (law.glsl)
  uint pad;
  vec4 obstacle_impulse[kMaxObstacles];  // xyz momentum that each obstacle gave the nodes over the tick [N s]; w number of nodes touched
  vec4 obstacle_angular[kMaxObstacles];  // xyz moment of that momentum about the obstacle's position at the end of the tick [N m s]
};

#ifdef __cplusplus
}}  // namespace viscera::layout
#endif
#endif
