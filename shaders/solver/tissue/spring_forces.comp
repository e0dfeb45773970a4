// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// spring_forces.comp - edge-centric forces (GW 4.2): each explicit connection once, by the end that owns it.
// Owner: solver/gpu/forces/spring_force_pass.h
// in  displacement, velocity [slots], owners, links     out  link_forces [springs + owners] N (SpringOwner)
// GW scatters by blending; here the owner sums what its springs do to it and writes each force on a far end to a place of its
// own, and the integrator sums what lies there for a node, one behind the other.
// Feature: DASHPOT.
#include "layout.h"
#include "solver/tissue/lattice.glsl"
#include "solver/tissue/elastic.glsl"

#ifndef __cplusplus
layout(binding = kUnitSpringOwners) uniform usamplerBuffer owners;  // SpringOwner
layout(std430, binding = kBindLinkForces) writeonly buffer LinkForcesBuffer { vec4 link_forces[]; };
uniform uint owner_count;
#endif

void main() {
  uint i = globalIndex();
  if (i >= owner_count) return;
  uvec4 owner = texelFetch(owners, int(i));  // slot, first, end, place
  vec3 u = xyz(stateAt(displacement, int(owner.x)));
#ifdef DASHPOT
  vec3 v = xyz(stateAt(velocity, int(owner.x)));
  float dashpot_s = bodies[bodyAt(owner.x)].dashpot_s;
#endif
  vec3 sum = vec3(0.0f);
  for (uint l = owner.y; l < owner.z; ++l) {
    Link link = linkAt(l);
    Spring s = springBetween(xyz(link.offset_length), link.offset_length.w, link.prestrain_m2, xyz(stateAt(displacement, int(link.far))) - u);
    vec3 force = (link.stiffness * s.extension) * s.direction;
#ifdef DASHPOT
    force += (link.stiffness * dashpot_s * dot(xyz(stateAt(velocity, int(link.far))) - v, s.direction)) * s.direction;
#endif
    if (link.stiffness == 0.0f) force = vec3(0.0f);  // cut: whatever became of the far end
    sum += force;
    link_forces[link.lattice_spring >> kForcePlaceShift] = vec4(-force, 0.0f);
  }
  link_forces[owner.w] = vec4(sum, 0.0f);
}
