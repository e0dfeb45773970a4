// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// overlay_colors.comp - colours of vertices by the strain of the nodes that they are bound to.
// PALE: the surface's own colours, paler where it is pressed.   Owners: surface/overlay/node_overlay.h,
// surface/overlay/blanching.h
// in  skin[count], overlay_nodes[slots]     out  strain_colors[count] RGBA8
#include "layout.h"
layout(local_size_x = GROUP_SIZE) in;  // globalIndex() needs it
#include "solver/tissue/lattice.glsl"
#include "strain_scale.glsl"
#include "tissue_code.glsl"

uniform uint count;
#ifdef PALE
uniform vec4 body_blanching[kMaxBodies];  // x strength
layout(std430, binding = kBindSkinColors) readonly buffer SkinColorsBuffer { uint skin_colors[]; };
const vec3 kPale = vec3(0.90, 0.80, 0.70);  // sRGB: tissue without its blood
const float kPressed = 0.03;                // mean shortening of springs without blood: tissue of E = 20 kPa under 4
                                            // kPa, at which capillaries close, is shortened by a fifth along one axis;
                                            // the mean over all directions is a sixth of that

/// Returns a paler colour. @param alpha  distinguishes walls of wounds, which bleed, from the surface
/// (tissue_code.glsl)
vec3 blanched(vec3 color, float alpha, float share, float strain) {
  return isWall(alpha) ? color : mix(color, kPale, share * smoothstep(0.0, kPressed, -strain));
}
#endif
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
#ifdef PALE
  vec4 color = unpackUnorm4x8(skin_colors[vertex]);
  color.rgb = blanched(color.rgb, color.a, body_blanching[bodyAt(s.slot0)].x, strain);
  strain_colors[vertex] = packUnorm4x8(color);
#else
  strain_colors[vertex] = packUnorm4x8(vec4(strainColor(strain / strain_range), 1.0));
#endif
}
