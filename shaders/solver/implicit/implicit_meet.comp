// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// implicit_meet.comp - corrects the forces of contacts between nodes: a round of Jacobi by mass splitting, in which a node with n
// active contacts enters each with 1/n of its majoriser.
// Owner: solver/device/implicit_substep.h   physics.md 2, 8
// in, out  pairs (implicit_pairs.glsl)
#include "layout.h"
#include "solver/tissue/lattice.glsl"
#include "solver/implicit/implicit_pairs.glsl"

#ifndef __cplusplus
layout(std430, binding = kBindActive) readonly buffer ActiveBuffer { uint active_nodes[]; };
uniform uint active_count;
#endif

/// Returns the compliance of a node to a contact force [m/N].
float mobilityOf(uint slot) {
  float majoriser = node_pairs[3u * slot].w;
  return majoriser > 0.0f ? node_pairs[3u * slot + 1u].w / majoriser : 0.0f;
}

/// Returns the force of b on a [N]: the last one, corrected by the remaining overlap and slip.
/// @param a  has the lower slot, so that both ends compute the same   @param plane  xyz normal; w gap [m]
vec3 forceBetween(uint a, uint b, vec4 plane, vec3 last) {
  float give = mobilityOf(a) + mobilityOf(b);
  if (give == 0.0f) return vec3(0.0f);
  vec3 normal = xyz(plane), apart = xyz(node_pairs[3u * a + 1u]) - xyz(node_pairs[3u * b + 1u]);
  float pressure = max(0.0f, dot(last, normal) - (dot(apart, normal) + plane.w) / give);
  vec3 drag = last - apart / give;
  drag -= dot(drag, normal) * normal;
  float size = length(drag), most = pair_friction * pressure;
  return pressure * normal + (size > most ? most / size : 1.0f) * drag;
}

void main() {
  uint i = globalIndex();
  if (i >= active_count) return;
  uint slot = active_nodes[i];
  PairRun run = pairsOf(slot);
  if (run.count == 0u) return;
  vec4 sum = vec4(0.0f);
  for (uint end = run.first; end < run.first + run.count; ++end) {
    uint other = pair_words[otherWord(end)];
    bool first = slot < other;
    vec3 force = forceBetween(first ? slot : other, first ? other : slot, pair_rows[2u * end], xyz(pair_rows[2u * end + 1u]));
    pair_rows[2u * end + 1u] = vec4(force, 0.0f);
    if (force != vec3(0.0f)) sum += vec4(first ? force : -force, 1.0f);
  }
  node_pairs[3u * slot + 2u] = sum;
}
