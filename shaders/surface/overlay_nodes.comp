// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// overlay_nodes.comp - positions of nodes, and strain of their springs.   Owner: surface/overlay/node_strains.h
// in  nodes[count], displacement[count] m; of networks link_starts[count + 1], links[], rest[count] m,
// spring_cut[springs]
// out overlay_nodes[count] xyz m, w root mean square of (L - l0) / l0 over the intact springs of the node; 0 without
// any
// Features: NETWORK (some body is one), SIGNED (w is the mean of these strains: below 0 where tissue is pressed).
#include "layout.h"
layout(local_size_x = GROUP_SIZE) in;  // globalIndex() needs it
#include "solver/tissue/lattice.glsl"

uniform uint count;  // of slots
layout(std430, binding = kBindNodes) readonly buffer NodesBuffer { NodeBits nodes[]; };
layout(std430, binding = kBindDisplacementIn) readonly buffer DisplacementBuffer { vec4 displacement[]; };
layout(std430, binding = kBindOverlayNodes) writeonly buffer OverlayNodesBuffer { vec4 overlay_nodes[]; };
#ifdef SIGNED
float summed(float strain) { return strain; }
float meanOf(vec2 sum) { return sum.x / max(sum.y, 1.0); }
#else
float summed(float strain) { return strain * strain; }
float meanOf(vec2 sum) { return sqrt(sum.x / max(sum.y, 1.0)); }
#endif
#ifdef NETWORK
layout(std430, binding = kBindSpringCut) readonly buffer SpringCutBuffer { float spring_cut[]; };
layout(std430, binding = kBindOverlayLinkStarts) readonly buffer LinkStartsBuffer { uint link_starts[]; };
layout(std430, binding = kBindOverlayLinks) readonly buffer LinksBuffer { OverlayLink links[]; };

/// Returns the sum of the strains, or of their squares, and their number.
vec2 networkStrain(uint slot) {
  vec2 sum = vec2(0.0);
  for (uint i = link_starts[slot]; i < link_starts[slot + 1u]; ++i) {
    OverlayLink link = links[i];
    if (spring_cut[link.spring] != 0.0) continue;
    vec3 rest = tabulatedRest(link.far) - tabulatedRest(slot);
    float strain = length(rest + (xyz(displacement[link.far]) - xyz(displacement[slot]))) / link.rest_length - 1.0;
    sum += vec2(summed(strain), 1.0);
  }
  return sum;
}
#endif

/// Returns the same for a node of a lattice.
vec2 latticeStrain(uint slot) {
  NodeBits bits = nodes[slot];
  float spacing = bodies[bodyAt(slot)].origin_spacing.w;
  vec3 here = xyz(displacement[slot]);
  vec2 sum = vec2(0.0);
#define ADD_STRAIN(SPRING, OFFSET)                                                                        \
  if (springCount(bits, SPRING) != 0u) {                                                                  \
    vec3 rest = spacing * vec3(OFFSET), now = rest + (xyz(displacement[neighborSlot(slot, OFFSET)]) - here); \
    float strain = length(now) / length(rest) - 1.0;                                                      \
    sum += vec2(summed(strain), 1.0);                                                                    \
  }
  FOR_EACH_SPRING(ADD_STRAIN)
  return sum;
}

void main() {
  uint slot = globalIndex();
  if (slot >= count) return;
#ifdef NETWORK
  vec2 sum = bodies[bodyAt(slot)].connections == kNetwork ? networkStrain(slot) : latticeStrain(slot);
#else
  vec2 sum = latticeStrain(slot);
#endif
  overlay_nodes[slot] = vec4(restPosition(slot) + xyz(displacement[slot]), meanOf(sum));
}
