// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// gw_scatter.frag - what is blended.   Owner: bench/gw/gw_blend.h
// Targets of fixed point take what is between 0 and 1: of every force its positive parts are added and its negative
// ones subtracted, in two draws.
in vec3 color;
layout(location = 0) out vec4 blended;

void main() { blended = vec4(color, 0.0); }
