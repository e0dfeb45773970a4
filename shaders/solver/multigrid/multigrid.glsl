// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Integrator multigrid on the GPU: its arrays (layout/multigrid.h; physics.md 2). After elastic.glsl and step.glsl.
// Feature HELD: something may touch or hold nodes. INCREMENT: implicit.glsl comes before and has the nodes.
#ifndef INCREMENT
layout(std430, binding = kBindActive) readonly buffer ActiveBuffer { uint active_nodes[]; };
layout(std430, binding = kBindNodes) readonly buffer NodesBuffer { NodeBits nodes[]; };
uniform uint slot_count;
#endif
layout(std430, binding = kBindStepVectors) buffer StepVectorsBuffer { vec4 step_vectors[]; };
layout(std430, binding = kBindSystemVectors) buffer SystemVectorsBuffer { vec4 system_vectors[]; };
#ifdef HELD
layout(std430, binding = kBindTouched) buffer TouchedBuffer { vec4 touched[]; };

/// kTouches... of a node, kept in the bits of a number that no GPU takes for 0.
uint touchesOf(uint slot) { return floatBitsToUint(touched[kTouchedWay * slot_count + slot].w) & 0x7fffffu; }
void setTouches(uint slot, uint what) { touched[kTouchedWay * slot_count + slot].w = uintBitsToFloat(0x3f800000u | what); }
#endif

vec3 ofStep(uint vector, uint slot) { return step_vectors[vector * slot_count + slot].xyz; }
void setOfStep(uint vector, uint slot, vec3 value) { step_vectors[vector * slot_count + slot] = vec4(value, 0.0f); }
vec3 ofSystem(uint vector, uint slot) { return system_vectors[vector * slot_count + slot].xyz; }
void setOfSystem(uint vector, uint slot, vec3 value) { system_vectors[vector * slot_count + slot] = vec4(value, 0.0f); }

/// 1 of nodes that are solved for or held, 0 of others.
float movable(uint slot) { return system_vectors[kSystemInverse2 * slot_count + slot].w; }
/// Inertia and drag of the stage that is solved [N/m].
float diagonal(uint slot) { return system_vectors[kSystemInverse2 * slot_count + slot].z; }

/// 1 of nodes that are solved for, 0 of others.
float isFree(uint slot) {
#ifdef HELD
  return touched[kTouchedNormal * slot_count + slot].w != 0.0f ? 0.0f : movable(slot);
#else
  return movable(slot);
#endif
}

/// Without what is along the normals of the planes that a node keeps to.
vec3 projected(uint slot, vec3 x) {
#ifdef HELD
  vec3 normal = touched[kTouchedNormal * slot_count + slot].xyz, other = touched[kTouchedNormal2 * slot_count + slot].xyz;
  x -= dot(normal, x) * normal;
  x -= dot(other, x) * other;
#endif
  return x;
}
