// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// edges.comp - contact of probes and shafts with the surface between nodes, after leapfrog.comp.   Owner: solver/gpu/contact/edges_pass.h
// physics.md 5
// in  nodes that leapfrog.comp listed; tool motions     in/out  state at the end of the substep; impulses
// One group does all the work, as each round depends on the previous one. Features: LATTICE, NETWORK, PARTS (elastic.glsl).
#define TOOLS
#define MAKES_CELL_FORCES  // none are read
#include "layout.h"
#include "solver/tissue/lattice.glsl"
#include "solver/tissue/elastic.glsl"

uniform float dt_s;
uniform uint slot_count;
uniform float push_speed;
layout(std430, binding = kBindNodes) readonly buffer NodesBuffer { NodeBits nodes[]; };
layout(std430, binding = kBindDisplacementOut) coherent buffer DisplacementOut { vec4 next_displacement[]; };
layout(std430, binding = kBindVelocityOut) coherent buffer VelocityOut { vec4 next_velocity[]; };
layout(std430, binding = kBindEdgeNodes) buffer EdgeNodesBuffer {
  uint edge_count;
  uint edge_nodes[kMostEdgeNodes];
  vec4 edge_pushes[];  // [2 * kMostEdgeNodes]
};

#include "solver/tools/contact.glsl"
#include "solver/tools/skin.glsl"
#include "solver/tools/edges.glsl"

shared uint pushed;
uint lane() { return gl_LocalInvocationID.x; }

/// Returns a node's sums of weights times displacements of points, stored in the fourth components of the state, which are
/// otherwise 0.
vec2 edgeSums(uint slot) { return vec2(next_displacement[slot].w, next_velocity[slot].w); }

void sumEdges(EdgeTip tip, uint slot) {
  NodeBits bits = nodes[slot];
  BodyParams body = bodies[bodyOf(bits)];
  vec2 sums = vec2(0.0f);
#define VISIT_EDGE(n)                           \
  {                                             \
    EdgeShift asked = shiftOfEdge(tip, slot, n); \
    sums += asked.near * asked.shift;           \
  }
  FOR_EACH_EDGE
#undef VISIT_EDGE
  next_displacement[slot].w = sums.x;
  next_velocity[slot].w = sums.y;
  if (sums != vec2(0.0f)) pushed = 1u;
}

EdgePush pushOfEdges(EdgeTip tip, uint slot) {
  NodeBits bits = nodes[slot];
  BodyParams body = bodies[bodyOf(bits)];
  EdgePush push = {vec3(0.0f), vec3(0.0f)};
  vec2 sums = edgeSums(slot);
  if (sums == vec2(0.0f)) return push;
  float give = 1.0f / massAt(slot);
#define VISIT_EDGE(n)                                                                                      \
  {                                                                                                        \
    EdgeShift asked = shiftOfEdge(tip, slot, n);                                                           \
    if (asked.shift != vec2(0.0f)) addEdge(asked, vec2(give, 1.0f / massAt(n)), sums, edgeSums(n), push);  \
  }
  FOR_EACH_EDGE
#undef VISIT_EDGE
  return push;
}

/// Pushes all nodes once. @return whether any node was pushed; the same for all invocations
bool pushAll(uint stylus, EdgeTip tip, uint count) {
  if (lane() == 0u) pushed = 0u;
  barrier();
  for (uint i = lane(); i < count; i += gl_WorkGroupSize.x) sumEdges(tip, edge_nodes[i]);
  memoryBarrierBuffer();
  barrier();
  bool any = pushed != 0u;
  for (uint i = lane(); any && i < count; i += gl_WorkGroupSize.x) {
    EdgePush push = pushOfEdges(tip, edge_nodes[i]);
    edge_pushes[2u * i] = vec4(push.x, 0.0f);
    edge_pushes[2u * i + 1u] = vec4(push.v, 0.0f);
  }
  barrier();
  for (uint i = lane(); any && i < count; i += gl_WorkGroupSize.x) {
    next_displacement[edge_nodes[i]].w = 0.0f;
    next_velocity[edge_nodes[i]].w = 0.0f;
    giveEdges(stylus, edge_nodes[i], EdgePush(edge_pushes[2u * i].xyz, edge_pushes[2u * i + 1u].xyz));
  }
  memoryBarrierBuffer();
  barrier();
  return any;
}

void pushRounds(uint stylus, EdgeTip tip, uint count) {
  for (uint round = 0u; round < kEdgeRounds; ++round) {
    if (!pushAll(stylus, tip, count)) break;
  }
}

void main() {
  uint count = edge_count <= kMostEdgeNodes ? edge_count : 0u;
  barrier();
  if (lane() == 0u) edge_count = 0u;
  if (count == 0u) return;
  for (uint s = 0u; s < kMaxStyluses; ++s) {
    if (pushesByTip(tool_motions[s])) pushRounds(s, tipOf(tool_motions[s]), count);
#ifdef SHAFTS
    if (pushesByShaft(tool_motions[s])) pushRounds(s, shaftOf(tool_motions[s]), count);
#endif
  }
}
