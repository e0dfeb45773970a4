// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// bench_fma.comp - multiply-adds in registers, to measure the renderer's rate.
// Owner: bench/harness/machine/machine_gpu.cpp   out  results [invocations]
layout(local_size_x = GROUP_SIZE) in;
layout(std430, binding = 0) writeonly buffer Results {
  vec4 results[];
};
uniform int rounds;

void main() {
  // Eight concurrent chains hide the latency of one.
  vec4 a = vec4(gl_GlobalInvocationID.x), b = a + 1.0;
  vec4 factor = vec4(0.999), term = vec4(float(rounds) * 1e-6);
  for (int i = 0; i < rounds; ++i) {
    a = fma(a, factor, term);
    b = fma(b, factor, term);
  }
  uint group = gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x;
  uint index = group * gl_WorkGroupSize.x + gl_LocalInvocationID.x;
  if (index < uint(results.length())) results[index] = a + b;
}
