// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
// Checks that the structs shared with GLSL have the std430 layout in C++; those also used in uniform blocks the std140
// layout: arrays of them in steps of 16 bytes.
#include <cstddef>

#include "layout/awake_bricks.h"
#include "layout/bindings.h"
#include "layout/network_skin.h"
#include "layout/surface_node.h"
#include "layout/wind.h"
#include "viscera/layout/limits.h"
#include "viscera/layout/links.h"
#include "viscera/layout/nodes.h"
#include "viscera/layout/obstacle_motion.h"
#include "viscera/layout/skin.h"
#include "viscera/layout/tick_stats.h"
#include "viscera/layout/tool_motion.h"

namespace viscera::layout {

#define AT(Struct, member, bytes) static_assert(offsetof(Struct, member) == (bytes), #Struct "." #member)
#define SIZE(Struct, bytes) static_assert(sizeof(Struct) == (bytes), #Struct)

SIZE(vec4, 16);
SIZE(uvec4, 16);
SIZE(ivec4, 16);

SIZE(NodeBits, 8);
AT(NodeBits, hi, 4);

SIZE(Brick, 4 * kBrickWords);
AT(Brick, coord_y, 4);
AT(Brick, coord_z, 8);
AT(Brick, body, 12);
AT(Brick, neighbors, 4 * kBrickNeighborWord);
AT(Brick, pad, 124);

SIZE(BodyParams, 64);
AT(BodyParams, axial_quarter_n_per_m, 16);
AT(BodyParams, diagonal_half_n_per_m, 20);
AT(BodyParams, mass_eighth_kg, 24);
AT(BodyParams, mass_damping_per_s, 28);
AT(BodyParams, dashpot_s, 32);
AT(BodyParams, bulk_j, 36);
AT(BodyParams, rigidity_j, 44);
AT(BodyParams, connections, 40);
AT(BodyParams, law, 48);
AT(BodyParams, stiffening, 52);

SIZE(Link, 32);  // two texels (solver/tissue/network.glsl)
AT(Link, stiffness, 16);
AT(Link, prestrain_m2, 20);
AT(Link, far, 24);
AT(Link, lattice_spring, 28);

SIZE(SpringEnds, 16);
AT(SpringEnds, b, 4);
AT(SpringEnds, link_a, 8);
AT(SpringEnds, link_b, 12);

SIZE(ToolMotion, 256);
AT(ToolMotion, to, 16);
AT(ToolMotion, orientation, 32);
AT(ToolMotion, blade_from, 48);
AT(ToolMotion, blade_to, 64);
AT(ToolMotion, info, 80);
AT(ToolMotion, timing, 96);
AT(ToolMotion, shaft_from, 112);
AT(ToolMotion, shaft_far_to, 160);
static_assert(kMaxStyluses * sizeof(ToolMotion) % 256 == 0, "a substep's tools begin where a uniform block may");

SIZE(ObstacleMotion, 128);
AT(ObstacleMotion, to, 16);
AT(ObstacleMotion, from_orientation, 32);
AT(ObstacleMotion, to_orientation, 48);
AT(ObstacleMotion, velocity, 64);
AT(ObstacleMotion, spin, 80);
AT(ObstacleMotion, half_size, 96);
AT(ObstacleMotion, info, 112);

SIZE(TickStats, 128 + 32 * kMaxObstacles);
AT(TickStats, obstacle_impulse, 128);
AT(TickStats, angular, 32);
AT(TickStats, springs_cut, 64);
AT(TickStats, nonfinite, 68);
AT(TickStats, max_stretch_bits, 72);
AT(TickStats, max_speed_bits, 76);
AT(TickStats, grabbed, 80);
AT(TickStats, touched, 88);
AT(TickStats, collapsed, 96);
AT(TickStats, max_rate_bits, 100);
AT(TickStats, kinetic_j, 104);
AT(TickStats, elastic_j, 108);
AT(TickStats, inverted, 112);
AT(TickStats, crowded, 116);

SIZE(SkinBinding, 96);
AT(SkinBinding, slot1, 4);
AT(SkinBinding, slot2, 8);
AT(SkinBinding, springs, 12);
AT(SkinBinding, weights, 16);
AT(SkinBinding, offset_constant, 32);
AT(SkinBinding, offset_interpolated, 48);
AT(SkinBinding, normal_constant, 64);
AT(SkinBinding, normal_interpolated, 80);

SIZE(SurfaceNode, 16);
AT(SurfaceNode, normal_x, 4);
AT(SurfaceNode, normal_y, 8);
AT(SurfaceNode, normal_z, 12);
SIZE(RingVertex, 32);
AT(RingVertex, slot, 4);
AT(RingVertex, ring_begin, 8);
AT(RingVertex, ring_end, 12);
AT(RingVertex, rest_normal, 16);

SIZE(RingTriangle, 16);
AT(RingTriangle, slot2, 4);
AT(RingTriangle, triangle, 8);

SIZE(SplitEdge, 16);
AT(SplitEdge, b, 4);
AT(SplitEdge, spring, 8);
AT(SplitEdge, vertex, 12);

SIZE(SplitTriangle, 64);
AT(SplitTriangle, springs, 4);
AT(SplitTriangle, vertices, 16);
AT(SplitTriangle, slots, 40);

SIZE(WindTriangle, 24);
AT(WindTriangle, c, 4);
AT(WindTriangle, springs, 8);

SIZE(SleepingBrick, 48);
AT(SleepingBrick, kind, 8);
AT(SleepingBrick, first_node, 20);
SIZE(AwakeList, 32);
AT(AwakeList, count, 12);
AT(AwakeList, bricks, 16);

#undef AT
#undef SIZE

constexpr uint kUnits[] = {kUnitDisplacement, kUnitVelocity,   kUnitBricks,     kUnitSpringStiffness, kUnitNodeMass,
                           kUnitCellBulk,     kUnitCellForces, kUnitIncrement,  kUnitPositions,       kUnitLinks,
                           kUnitLinkStarts,   kUnitRest,       kUnitCellMoments};
constexpr uint kDrawingUnits[] = {kUnitShownCharts, kUnitCharts, kUnitMaterials, kUnitColors, kUnitReliefs, kUnitGrain};

/// Returns whether each unit is used once and within OpenGL's guarantee: 16 units per stage, 80 for all stages
/// together.
constexpr bool eachOnceAndPromised() {
  uint taken = 0;
  for (const uint unit : kUnits) {
    if (unit >= 16 || (taken & 1u << unit) != 0) return false;
    taken |= 1u << unit;
  }
  for (const uint unit : kDrawingUnits) {
    if (unit < 16 || unit >= 32 || (taken & 1u << unit) != 0) return false;
    taken |= 1u << unit;
  }
  return true;
}
static_assert(eachOnceAndPromised(), "a texture unit is used twice, or OpenGL does not promise it");

}  // namespace viscera::layout
