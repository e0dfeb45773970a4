// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// gw_owned.comp - edge-centric forces (GW 4.2), first pass: each spring once, by the end that owns it, as the solver does it
// (spring_forces.comp).   Owner: bench/gw/gw_kernels.h
// in  displacement [nodes], owners, links     out  link_forces [springs + owners] N (SpringOwner)
#include "gw_mesh.glsl"

layout(binding = kUnitSpringOwners) uniform usamplerBuffer owners;  // SpringOwner
layout(std430, binding = 0) writeonly buffer LinkForces { vec4 link_forces[]; };

void main() {
  uint i = globalIndex();
  if (i >= count) return;
  uvec4 owner = texelFetch(owners, int(i));  // slot, first, end, place
  vec3 u = texelFetch(displacement, int(owner.x)).xyz;
  vec3 sum = vec3(0.0);
  for (uint l = owner.y; l < owner.z; ++l) {
    Link link = linkAt(l);
    vec3 force = linkForce(link, texelFetch(displacement, int(link.far)).xyz - u);
    sum += force;
    link_forces[link.lattice_spring >> kForcePlaceShift] = vec4(-force, 0.0);
  }
  link_forces[owner.w] = vec4(sum, 0.0);
}
