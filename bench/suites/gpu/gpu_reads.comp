// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// gpu_reads.comp - gathers the 18 neighbours of a node, to measure the cost of different reads.
// Owner: bench/suites/gpu/gpu_suite.cpp
// in  state [nodes] of a cube, line by line     out  sums [nodes]
// Features, one of: STORAGE (vec4 in a storage buffer), TEXELS (vec4 by texel fetches), IMAGES (vec4 by image loads),
// PACKED (three floats in a storage buffer), HALVES (three 16-bit floats, too coarse for stepping: shows the effect of
// size).
layout(local_size_x = GROUP_SIZE) in;
uniform int edge;

#if defined(STORAGE)
layout(std430, binding = 0) readonly buffer State { vec4 state[]; };
vec3 at(int i) { return state[i].xyz; }
#elif defined(TEXELS)
layout(binding = 0) uniform samplerBuffer state;
vec3 at(int i) { return texelFetch(state, i).xyz; }
#elif defined(IMAGES)
layout(binding = 0, rgba32f) readonly uniform imageBuffer state;
vec3 at(int i) { return imageLoad(state, i).xyz; }
#elif defined(PACKED)
layout(std430, binding = 0) readonly buffer State { float state[]; };
vec3 at(int i) { return vec3(state[3 * i], state[3 * i + 1], state[3 * i + 2]); }
#else
layout(std430, binding = 0) readonly buffer State { uvec2 state[]; };
vec3 at(int i) {
  uvec2 bits = state[i];
  return vec3(unpackHalf2x16(bits.x), unpackHalf2x16(bits.y).x);
}
#endif
layout(std430, binding = 1) writeonly buffer Sums { vec4 sums[]; };

void main() {
  uint group = gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x;
  int i = int(group * gl_WorkGroupSize.x + gl_LocalInvocationID.x), nodes = edge * edge * edge;
  if (i >= nodes) return;
  vec3 sum = vec3(0.0), own = at(i);
  for (int z = -1; z <= 1; ++z) {
    for (int y = -1; y <= 1; ++y) {
      for (int x = -1; x <= 1; ++x) {
        int axes = abs(x) + abs(y) + abs(z);
        if (axes == 0 || axes == 3) continue;
        sum += at(clamp(i + x + edge * (y + edge * z), 0, nodes - 1)) - own;
      }
    }
  }
  sums[i] = vec4(sum, 0.0);
}
