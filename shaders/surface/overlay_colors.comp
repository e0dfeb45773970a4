// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// overlay_colors.comp - the strain of a skin's vertices, from that of the nodes that they are bound to, as colours.
// Owner: surface/overlay/node_overlay.h
// in  skin[count], overlay_nodes[slots]     out  strain_colors[count] RGBA8
#include "layout.h"
layout(local_size_x = GROUP_SIZE) in;  // before globalIndex(), which asks for it
#include "solver/tissue/lattice.glsl"
#include "strain_scale.glsl"

uniform uint count;
uniform float strain_range;  // the end of the scale
layout(std430, binding = kBindSkinBindings) readonly buffer SkinBuffer { SkinBinding skin[]; };
layout(std430, binding = kBindOverlayNodes) readonly buffer OverlayNodesBuffer { vec4 overlay_nodes[]; };
layout(std430, binding = kBindStrainColors) writeonly buffer StrainColorsBuffer { uint strain_colors[]; };

void main() {
  uint vertex = globalIndex();
  if (vertex >= count) return;
  SkinBinding s = skin[vertex];
  vec3 strains = vec3(overlay_nodes[s.slot0].w, overlay_nodes[s.slot1].w, overlay_nodes[s.slot2].w);
  bool one = (s.springs & kOneToOneBit) != 0u;
  float strain = one ? strains.x : dot(xyz(s.weights), strains);
  strain_colors[vertex] = packUnorm4x8(vec4(strainColor(strain / strain_range), 1.0));
}
