// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Shared code of the shaders of GW's experiments (bench/gw/gw_kernels.h): a network in the solver's own buffers, read
// by texel fetches. They are not the solver's kernels: those integrate in the same pass, while here each stage is timed
// separately.
#include "layout.h"
#include "bench/gw/gw_units.h"
#include "solver/tissue/spring.glsl"
#include "solver/tissue/network.glsl"

// rgba32f, or rgba16f if the state has 16-bit floats
layout(binding = kUnitDisplacement) uniform samplerBuffer displacement;

/// Returns the force [N] of a link on its near end. @param w  u_far - u_near [m]
vec3 linkForce(Link link, vec3 w) {
  Spring s = springBetween(link.offset_length.xyz, link.offset_length.w, link.prestrain_m2, w);
  return (link.stiffness * s.extension) * s.direction;
}
