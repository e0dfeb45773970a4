// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Shared code of the kernels of GW's experiments.
#include "gw_link.glsl"

layout(local_size_x = GROUP_SIZE) in;
uniform uint count;  // number of invocations

/// Returns the index of this invocation over all groups (gpu/program.cpp folds many groups into rows).
uint globalIndex() {
  return (gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x) * gl_WorkGroupSize.x + gl_LocalInvocationID.x;
}
