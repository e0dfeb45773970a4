// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// multigrid_coarse.comp - the levels below the lattice, and the ways between them.   Owner: solver/gpu/buffers/multigrid_levels.h   physics.md 2
// Features: PRODUCT (y = A x or y -= A x, rows of the graph), SOLVE (y = A^-1 x, all columns), SMOOTH (d = a d + b D^-1 r, z += d),
// RESTRICT (to a coarser level), PROLONG (to a finer one); with FINE from or to the lattice.
// Numbers of a level's nodes begin at *_first in their array; blocks are three columns of x, y, z and a zero.
#include "layout.h"
#include "solver/tissue/lattice.glsl"
#ifdef FINE
#include "solver/tissue/elastic.glsl"
#include "solver/tissue/step.glsl"
#include "solver/multigrid/multigrid.glsl"
#else
uniform uint active_count;  // nodes of the level that is written
#endif

layout(std430, binding = kBindCoarseVectors) buffer CoarseVectorsBuffer { vec4 coarse_vectors[]; };
layout(std430, binding = kBindCoarseMatrices) readonly buffer CoarseMatricesBuffer { vec4 coarse_matrices[]; };
layout(std430, binding = kBindCoarseGraph) readonly buffer CoarseGraphBuffer { uint coarse_graph[]; };
uniform uint x_first;        // vectors
uniform uint y_first;
uniform uint z_first;
uniform uint blocks_first;   // columns
uniform uint starts_first;   // words of the graph: where a node's entries begin, node by node, and the entries themselves
uniform uint entries_first;
uniform uint weights_first;  // of each entry, as bits
uniform uint subtract;
uniform uint first;
uniform float a;
uniform float b;

vec3 blockTimes(uint at, vec3 x) {
  return coarse_matrices[at].xyz * x.x + coarse_matrices[at + 1u].xyz * x.y + coarse_matrices[at + 2u].xyz * x.z;
}

#if defined(PRODUCT)
void each(uint node) {
  vec3 sum = vec3(0.0f);
  uint end = coarse_graph[starts_first + node + 1u];
  for (uint e = coarse_graph[starts_first + node]; e < end; ++e)
    sum += blockTimes(blocks_first + 3u * e, coarse_vectors[x_first + coarse_graph[entries_first + e]].xyz);
  if (subtract != 0u) sum = coarse_vectors[y_first + node].xyz - sum;
  coarse_vectors[y_first + node] = vec4(sum, 0.0f);
}
#elif defined(SOLVE)
void each(uint node) {
  vec3 sum = vec3(0.0f);
  for (uint column = 0u; column < active_count; ++column)
    sum += blockTimes(blocks_first + 3u * (node * active_count + column), coarse_vectors[x_first + column].xyz);
  coarse_vectors[y_first + node] = vec4(sum, 0.0f);
}
#elif defined(SMOOTH)
/// x: residual, y: change, z: solution
void each(uint node) {
  vec3 next = b * blockTimes(blocks_first + 3u * node, coarse_vectors[x_first + node].xyz);
  if (a != 0.0f) next += a * coarse_vectors[y_first + node].xyz;
  coarse_vectors[y_first + node] = vec4(next, 0.0f);
  vec3 z = first != 0u ? vec3(0.0f) : coarse_vectors[z_first + node].xyz;
  coarse_vectors[z_first + node] = vec4(z + next, 0.0f);
}
#else
/// What a node takes from others.
vec3 taken(uint node) {
  vec3 sum = vec3(0.0f);
  uint end = coarse_graph[starts_first + node + 1u];
  for (uint e = coarse_graph[starts_first + node]; e < end; ++e) {
    uint other = coarse_graph[entries_first + e];
#if defined(FINE) && defined(RESTRICT)
    vec3 value = ofSystem(kSystemWork, other);  // slots
#else
    vec3 value = coarse_vectors[x_first + other].xyz;
#endif
    sum += uintBitsToFloat(coarse_graph[weights_first + e]) * value;
  }
  return sum;
}

#ifdef RESTRICT
void each(uint node) { coarse_vectors[y_first + node] = vec4(taken(node), 0.0f); }
#elif defined(FINE)
void each(uint node) {
  uint slot = active_nodes[node];
  vec3 change = projected(slot, isFree(slot) * taken(node));
  setOfSystem(kSystemChange, slot, change);
  setOfSystem(kSystemCorrection, slot, ofSystem(kSystemCorrection, slot) + change);
}
#else
void each(uint node) {
  vec3 change = taken(node);
  coarse_vectors[y_first + node] = vec4(change, 0.0f);
  coarse_vectors[z_first + node] += vec4(change, 0.0f);
}
#endif
#endif

void main() {
  uint i = globalIndex();
  if (i < active_count) each(i);
}
