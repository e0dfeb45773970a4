// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// gw_integrate.comp - a leapfrog substep from given forces (physics.md 2).   Owner: bench/gw/gw_kernels.h
// in  displacement, velocity, forces [nodes]     out  the new ones
// Features: TARGET (forces are in the texture of a blending target), HALF (the state is in 16-bit floats).
#include "gw_mesh.glsl"

layout(binding = kUnitVelocity) uniform samplerBuffer velocity;  // in the format of displacement
layout(binding = kUnitInverseMass) uniform samplerBuffer inverse_mass;  // r32f [nodes] 1/kg; 0 for fixed nodes
uniform float dt_s;
uniform float kick_s;
uniform float mass_damping_per_s;
uniform vec3 gravity;
#ifdef TARGET
uniform vec2 decoding;  // x force of the value 1 [N]; y value that represents zero force
layout(binding = kUnitForces) uniform sampler2D target;
vec3 forceOn(uint node) {
  uint width = uint(textureSize(target, 0).x);
  return decoding.x * (texelFetch(target, ivec2(node % width, node / width), 0).xyz - decoding.y);
}
#else
layout(binding = kUnitForces) uniform samplerBuffer forces;
vec3 forceOn(uint node) { return texelFetch(forces, int(node)).xyz; }
#endif

#ifdef HALF
layout(std430, binding = 0) writeonly buffer NextDisplacement { uvec2 next_displacement[]; };
layout(std430, binding = 1) writeonly buffer NextVelocity { uvec2 next_velocity[]; };
uvec2 stored(vec3 v) { return uvec2(packHalf2x16(v.xy), packHalf2x16(vec2(v.z, 0.0))); }
#else
layout(std430, binding = 0) writeonly buffer NextDisplacement { vec4 next_displacement[]; };
layout(std430, binding = 1) writeonly buffer NextVelocity { vec4 next_velocity[]; };
vec4 stored(vec3 v) { return vec4(v, 0.0); }
#endif

void main() {
  uint node = globalIndex();
  if (node >= count) return;
  vec3 u = texelFetch(displacement, int(node)).xyz, v = texelFetch(velocity, int(node)).xyz;
  float per_kg = texelFetch(inverse_mass, int(node)).x;
  if (per_kg > 0.0) {
    float g = 0.5 * mass_damping_per_s * kick_s;
    v += (kick_s * (per_kg * forceOn(node) + gravity) - (2.0 * g) * v) / (1.0 + g);
    u += dt_s * v;
  }
  next_displacement[node] = stored(u);
  next_velocity[node] = stored(v);
}
