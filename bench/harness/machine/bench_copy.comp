// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// bench_copy.comp - copies memory, to measure the renderer's copy rate.   Owner: bench/harness/machine/machine_gpu.cpp
// in  from [count]     out  to [count]
layout(local_size_x = GROUP_SIZE) in;
layout(std430, binding = 0) restrict readonly buffer From {
  vec4 from[];
};
layout(std430, binding = 1) restrict writeonly buffer To {
  vec4 to[];
};

void main() {
  uint group = gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x;
  uint index = group * gl_WorkGroupSize.x + gl_LocalInvocationID.x;
  if (index < uint(to.length())) to[index] = from[index];
}
