// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// overlay_spikes.comp - a line at every node of a list: its normal, or the force on its body.   Owner: surface/overlay/node_overlay.h
// in  overlay_spikes[count], overlay_nodes[slots] m, node_normals[slots], normals[vertices] packed     out  overlay_ends[2 * count] m
#include "layout.h"
layout(local_size_x = GROUP_SIZE) in;  // globalIndex() needs it
#include "solver/tissue/lattice.glsl"
#include "pack.glsl"

uniform uint count;
uniform uint kind;                      // kSpikesAreNormals, kSpikesAreForces
uniform vec4 body_spikes[kMaxBodies];   // kSpikesAreNormals: x length [m]; kSpikesAreForces: xyz from the far end to the node [m]
layout(std430, binding = kBindOverlayNodes) readonly buffer OverlayNodesBuffer { vec4 overlay_nodes[]; };
layout(std430, binding = kBindOverlaySpikes) readonly buffer OverlaySpikesBuffer { OverlaySpike overlay_spikes[]; };
layout(std430, binding = kBindOverlayEnds) writeonly buffer OverlayEndsBuffer { vec4 overlay_ends[]; };
layout(std430, binding = kBindNodeNormals) readonly buffer NodeNormalsBuffer { vec4 node_normals[]; };
layout(std430, binding = kBindSkinNormals) readonly buffer NormalsBuffer { uint normals[]; };

/// Returns the normal of a node, shorter where it is less trusted.
vec3 normalAt(OverlaySpike spike) {
  if (spike.vertex != 0u) return unpackNormal(normals[spike.vertex - 1u]);
  return xyz(node_normals[spike.slot]) * node_normals[spike.slot].w;
}

void main() {
  uint index = globalIndex();
  if (index >= count) return;
  OverlaySpike spike = overlay_spikes[index];
  vec4 of_body = body_spikes[bodyAt(spike.slot)];
  vec3 node = xyz(overlay_nodes[spike.slot]);
  bool force = kind == kSpikesAreForces;
  overlay_ends[2u * index] = vec4(node, 1.0);
  overlay_ends[2u * index + 1u] = vec4(force ? node - xyz(of_body) : node + of_body.x * normalAt(spike), 1.0);
}
