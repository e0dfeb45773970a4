// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The implicit lattice: bricks of 4x4x4 nodes, neighbours by offset, springs as small counts. model/body/neighbors.h is its C++
// version.
#include "layout.h"

#ifndef __cplusplus  // in C++ src/solver/cpu/kernels/glsl_kernel.h provides bricks and bodies
layout(local_size_x = GROUP_SIZE) in;
// Two kinds of access to the same buffers. Feature TEXELS (the solver's kernels): bricks by texel fetch, bodies in a uniform
// block, which software rasterisers run several times faster than storage loads; otherwise storage buffers. With LOADS in
// addition (set by gpu/program.cpp where a driver supports enough blocks) the data of neighbours are read by storage loads again,
// which a GPU runs several times faster than texel fetches of 16 bytes.
#ifdef LOADS
#define stateAt(name, index) name[index]
#else
#define stateAt(name, index) texelFetch(name, index)
#endif
#ifdef TEXELS
layout(std140, binding = kBindBodies) uniform BodiesBlock { BodyParams bodies[kMaxBodies]; };
#ifdef LOADS
layout(std430, binding = kBindBricks) restrict readonly buffer BricksBuffer { uint brick_words[]; };
uint brickWord(uint slot, uint word) { return brick_words[(slot >> 6) * kBrickWords + word]; }
#else
layout(binding = kUnitBricks) uniform usamplerBuffer brick_words;
uint brickWord(uint slot, uint word) { return texelFetch(brick_words, int((slot >> 6) * kBrickWords + word)).x; }
#endif
uint neighborBrick(uint slot, uint direction) { return brickWord(slot, kBrickNeighborWord + direction); }
ivec3 brickCoord(uint slot) { return ivec3(brickWord(slot, 0u), brickWord(slot, 1u), brickWord(slot, 2u)); }
uint brickBody(uint slot) { return brickWord(slot, 3u); }
#else
layout(std430, binding = kBindBricks) readonly buffer BricksBuffer { Brick bricks[]; };
layout(std430, binding = kBindBodies) readonly buffer BodiesBuffer { BodyParams bodies[]; };
uint neighborBrick(uint slot, uint direction) { return bricks[slot >> 6].neighbors[direction]; }
ivec3 brickCoord(uint slot) {
  uint b = slot >> 6;
  return ivec3(bricks[b].coord_x, bricks[b].coord_y, bricks[b].coord_z);
}
uint brickBody(uint slot) { return bricks[slot >> 6].body; }
#endif
#ifdef NETWORK  // some body has explicit connections: rest positions of its nodes are in a table
#ifdef TEXELS
layout(binding = kUnitRest) uniform samplerBuffer rest_positions;
vec3 tabulatedRest(uint slot) { return texelFetch(rest_positions, int(slot)).xyz; }
#else
layout(std430, binding = kBindRest) readonly buffer RestBuffer { vec4 rest_positions[]; };
vec3 tabulatedRest(uint slot) { return rest_positions[slot].xyz; }
#endif
#endif

/// Returns the index of this invocation over all groups (gpu/program.cpp folds many groups into rows).
uint globalIndex() {
  return (gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x) * gl_WorkGroupSize.x + gl_LocalInvocationID.x;
}
#endif

/// Calls APPLY(spring, offset) for the 18 springs in the order of model/body/neighbors.h; the opposite of s is s ^ 1.
#define FOR_EACH_SPRING(APPLY)                                                                                  \
  APPLY(0u, ivec3(1, 0, 0)) APPLY(1u, ivec3(-1, 0, 0)) APPLY(2u, ivec3(0, 1, 0)) APPLY(3u, ivec3(0, -1, 0))     \
  APPLY(4u, ivec3(0, 0, 1)) APPLY(5u, ivec3(0, 0, -1))                                                          \
  APPLY(6u, ivec3(1, 1, 0)) APPLY(7u, ivec3(-1, -1, 0)) APPLY(8u, ivec3(1, -1, 0)) APPLY(9u, ivec3(-1, 1, 0))   \
  APPLY(10u, ivec3(1, 0, 1)) APPLY(11u, ivec3(-1, 0, -1)) APPLY(12u, ivec3(1, 0, -1)) APPLY(13u, ivec3(-1, 0, 1)) \
  APPLY(14u, ivec3(0, 1, 1)) APPLY(15u, ivec3(0, -1, -1)) APPLY(16u, ivec3(0, 1, -1)) APPLY(17u, ivec3(0, -1, 1))

ivec3 localCoord(uint slot) { return ivec3(slot & 3u, (slot >> 2) & 3u, (slot >> 4) & 3u); }

/// Returns the index of a node's number in an array with `planes` numbers per node: brick by brick, each number in a plane of its
/// own, so neighbouring invocations read neighbouring words.
uint inPlanes(uint slot, uint plane, uint planes) { return ((slot >> 6) * planes + plane) * kBrickSlots + (slot & (kBrickSlots - 1u)); }

/// Returns the slot of the neighbour at an offset of -1, 0, 1 per axis. Without a node there, some valid slot: its spring count
/// is 0.
uint neighborSlot(uint slot, ivec3 offset) {
  ivec3 p = localCoord(slot) + offset;  // -1 .. 4
  ivec3 side = (p + 4) >> 2;            // 0, 1, 2
  uint brick = neighborBrick(slot, uint(side.x + 3 * side.y + 9 * side.z));
  uvec3 q = uvec3(p & 3);
  return brick * kBrickSlots + q.x + 4u * q.y + 16u * q.z;
}

/// Returns the strength of a spring: axial 0..4 quarters, diagonal 0..2 halves.
uint springCount(NodeBits bits, uint spring) {
  return spring < kAxialSprings ? (bits.lo >> (3u * spring)) & 7u : (bits.hi >> (2u * (spring - kAxialSprings))) & 3u;
}

NodeBits withoutSpring(NodeBits bits, uint spring) {
  if (spring < kAxialSprings) bits.lo &= ~(7u << (3u * spring));
  else bits.hi &= ~(3u << (2u * (spring - kAxialSprings)));
  bits.lo |= kSeveredBit;
  return bits;
}

#ifdef SINGLE_BODY
uint bodyOf(NodeBits bits) { return 0u; }
uint bodyAt(uint slot) { return 0u; }
#else
uint bodyOf(NodeBits bits) { return bits.hi >> kBodyShift; }
uint bodyAt(uint slot) { return brickBody(slot); }
#endif
bool isIsolated(NodeBits bits) { return (bits.lo & kAxialMask) == 0u && (bits.hi & kDiagonalMask) == 0u; }

/// Returns the integer coordinates of a node, from its body's node (0, 0, 0).
ivec3 nodeCoord(uint slot) { return brickCoord(slot) * int(kBrickEdge) + localCoord(slot); }

/// Returns the rest position of a node [m, tissue frame].
vec3 restPosition(uint slot) {
  BodyParams body = bodies[bodyAt(slot)];
#ifdef NETWORK
  if (body.connections == kNetwork) return tabulatedRest(slot);
#endif
  return xyz(body.origin_spacing) + body.origin_spacing.w * vec3(nodeCoord(slot));
}
