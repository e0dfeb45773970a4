// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// save_state.comp - copies the state to the storage of a good one.   Owner: solver/gpu/good_states.h
// in  displacement, velocity [slots]     out  saved displacement and velocity [slots]
// Used on GPUs, where drivers copy buffers at a tenth of the speed of kernels or less (docs/gpu.md).
layout(local_size_x = GROUP_SIZE) in;
#include "layout.h"

layout(std430, binding = kBindDisplacementIn) readonly buffer DisplacementIn { vec4 displacement[]; };
layout(std430, binding = kBindVelocityIn) readonly buffer VelocityIn { vec4 velocity[]; };
layout(std430, binding = kBindSavedDisplacement) writeonly buffer SavedDisplacement { vec4 saved_displacement[]; };
layout(std430, binding = kBindSavedVelocity) writeonly buffer SavedVelocity { vec4 saved_velocity[]; };
uniform uint slot_count;

void main() {
  uint slot = (gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x) * gl_WorkGroupSize.x + gl_LocalInvocationID.x;
  if (slot >= slot_count) return;
  saved_displacement[slot] = displacement[slot];
  saved_velocity[slot] = velocity[slot];
}
