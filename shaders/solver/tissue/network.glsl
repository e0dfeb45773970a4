// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Explicit connections (VR05 2.5.1, GW 4): a node's links are consecutive. After lattice.glsl and spring.glsl.
#ifndef __cplusplus
layout(binding = kUnitLinkStarts) uniform usamplerBuffer link_starts;  // [slots + 1]
layout(binding = kUnitLinks) uniform usamplerBuffer link_words;        // two texels per Link
uint linkStart(uint slot) { return texelFetch(link_starts, int(slot)).x; }
Link linkAt(uint link) {
  uvec4 position = texelFetch(link_words, int(2u * link)), strength = texelFetch(link_words, int(2u * link + 1u));
  return Link(uintBitsToFloat(position), uintBitsToFloat(strength.x), uintBitsToFloat(strength.y), strength.z, strength.w);
}
#endif

/// Loops over the links of a node.
#define FOR_EACH_LINK_INDEX(link)                                                  \
    uint link_end = linkStart(slot + 1u);                                          \
    for (uint link = linkStart(slot); link < link_end; ++link)

/// As FOR_EACH_LINK (elastic.glsl), for a node with explicit connections.
#define FOR_EACH_NETWORK_LINK                                                      \
  {                                                                                \
    FOR_EACH_LINK_INDEX(link) {                                                    \
      Link it = linkAt(link);                                                      \
      if (it.stiffness != 0.0f) {                                                  \
        uint n = it.far;                                                           \
        bool counted = slot < n;                                                   \
        float k = it.stiffness, l0 = it.offset_length.w, prestrain = it.prestrain_m2; \
        vec3 d = xyz(it.offset_length);                                            \
        VISIT_LINK                                                                 \
      }                                                                            \
    }                                                                              \
  }
