// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// overlay_lines.comp - springs as lines between slots.   Owner: surface/overlay/node_overlay.h
// in  overlay_lines[count], nodes[slots], spring_cut[springs]     out  overlay_indices[2 * count]
// Feature: NETWORK (some body is one).
#include "layout.h"
layout(local_size_x = GROUP_SIZE) in;  // globalIndex() needs it
#include "solver/tissue/lattice.glsl"

uniform uint count;
layout(std430, binding = kBindNodes) readonly buffer NodesBuffer { NodeBits nodes[]; };
layout(std430, binding = kBindOverlayLines) readonly buffer OverlayLinesBuffer { OverlayLine overlay_lines[]; };
layout(std430, binding = kBindOverlayIndices) writeonly buffer OverlayIndicesBuffer { uint overlay_indices[]; };
#ifdef NETWORK
layout(std430, binding = kBindSpringCut) readonly buffer SpringCutBuffer { float spring_cut[]; };
#endif

bool isWhole(OverlayLine line) {
#ifdef NETWORK
  if (line.of_network != 0u) return spring_cut[line.spring] == 0.0;
#endif
  return springCount(nodes[line.a], line.spring) != 0u;
}

void main() {
  uint index = globalIndex();
  if (index >= count) return;
  OverlayLine line = overlay_lines[index];
  overlay_indices[2u * index] = line.a;
  overlay_indices[2u * index + 1u] = isWhole(line) ? line.b : line.a;
}
