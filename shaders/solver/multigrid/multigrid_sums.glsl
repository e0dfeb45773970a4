// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Sums over nodes or cells in float64, always in the same order: those of each group here, theirs in multigrid_sum.comp.
layout(std430, binding = kBindPartials) buffer PartialsBuffer { dvec4 partials[]; };
shared dvec4 lanes[GROUP_SIZE];

/// All invocations of a group call it, in the same order. @param row  of the partial sums
void sumUp(uint row, dvec4 term) {
  uint lane = gl_LocalInvocationID.x;
  lanes[lane] = term;
  for (uint width = GROUP_SIZE; width > 1u;) {
    uint above = (width + 1u) / 2u;
    barrier();
    if (lane + above < width) lanes[lane] += lanes[lane + above];
    width = above;
  }
  if (lane == 0u) {
    uint groups = gl_NumWorkGroups.x * gl_NumWorkGroups.y;
    partials[row * groups + gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x] = lanes[0];
  }
  barrier();
}
