// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// multigrid_sum.comp - sums partial sums, a group for each row, and what an iteration makes of them.
// Owner: solver/gpu/steps/multigrid_stages.h   physics.md 2
// in  partials [rows * count]     out  sums from first_row on; alpha, beta
#include "layout.h"
#include "solver/tissue/lattice.glsl"

layout(std430, binding = kBindPartials) readonly buffer PartialsBuffer { dvec4 partials[]; };
layout(std430, binding = kBindSums) buffer SumsBuffer {
  MultigridScalars scalars;
  dvec4 sums[];
};
uniform uint count;
uniform uint first_row;
uniform uint first_iteration;
shared dvec4 lanes[GROUP_SIZE];

/// Step along a direction, and how much of the last one stays in the next; 0 where there is none.
void conclude(uint row, dvec4 sum) {
  if (row == kSumsRz) {
    double before = sums[kSumsRz].x;
    scalars.beta = first_iteration != 0u || !(before > 0.0LF) ? 0.0f : float(sum.x / before);
  } else if (row == kSumsCurvature) {
    double rz = sums[kSumsRz].x;
    scalars.alpha = rz > 0.0LF && sum.x > 0.0LF ? float(rz / sum.x) : 0.0f;
  }
  sums[row] = sum;
}

void main() {
  uint lane = gl_LocalInvocationID.x, first = gl_WorkGroupID.x * count;
  dvec4 sum = dvec4(0.0LF);
  for (uint i = lane; i < count; i += GROUP_SIZE) sum += partials[first + i];
  lanes[lane] = sum;
  for (uint width = GROUP_SIZE; width > 1u;) {
    uint above = (width + 1u) / 2u;
    barrier();
    if (lane + above < width) lanes[lane] += lanes[lane + above];
    width = above;
  }
  if (lane == 0u) conclude(first_row + gl_WorkGroupID.x, lanes[0]);
}
