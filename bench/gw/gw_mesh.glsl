// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What the kernels of GW's experiments have in common.
#include "gw_link.glsl"

layout(local_size_x = GROUP_SIZE) in;
uniform uint count;  // invocations wanted

/// Index of this invocation over all groups (gpu/program.cpp folds many groups into rows).
uint globalIndex() {
  return (gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x) * gl_WorkGroupSize.x + gl_LocalInvocationID.x;
}
