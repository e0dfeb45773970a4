// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Explicit connections (VR05 2.5.1, GW 4): a node's links lie one behind the other. After lattice.glsl and spring.glsl.
// Feature: EDGE_FORCES (in two runs: those of springs that it owns among all such links, then the others; solver/tissue/edge_forces.h)
#ifndef __cplusplus
layout(binding = kUnitLinkStarts) uniform usamplerBuffer link_starts;  // [slots + 1]; EDGE_FORCES: rgba32ui [slots], both runs
layout(binding = kUnitLinks) uniform usamplerBuffer link_words;        // two texels per Link
#ifdef EDGE_FORCES
uvec4 linkRuns(uint slot) { return texelFetch(link_starts, int(slot)); }
#else
uint linkStart(uint slot) { return texelFetch(link_starts, int(slot)).x; }
#endif
Link linkAt(uint link) {
  uvec4 place = texelFetch(link_words, int(2u * link)), strength = texelFetch(link_words, int(2u * link + 1u));
  return Link(uintBitsToFloat(place), uintBitsToFloat(strength.x), uintBitsToFloat(strength.y), strength.z, strength.w);
}
#endif

/// The links of a node. C++ asks at run time whether they are in one run or in two.
#if defined(EDGE_FORCES) || defined(__cplusplus)
#define FOR_EACH_LINK_INDEX(link)                                                  \
    uvec4 runs = linkRuns(slot);                                                   \
    for (uint link = runs.x == runs.y ? runs.z : runs.x; link < runs.w; link = link + 1u == runs.y ? runs.z : link + 1u)
#else
#define FOR_EACH_LINK_INDEX(link)                                                  \
    uint link_end = linkStart(slot + 1u);                                          \
    for (uint link = linkStart(slot); link < link_end; ++link)
#endif

/// As FOR_EACH_LINK (elastic.glsl), of a node with explicit connections.
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
