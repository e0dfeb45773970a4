// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// gw_scatter.frag - the value that is blended.   Owner: bench/gw/gw_blend.h
// Fixed-point targets accept values between 0 and 1. In two draws, the positive components of every force are added and
// the negative ones subtracted.
in vec3 color;
layout(location = 0) out vec4 blended;

void main() { blended = vec4(color, 0.0); }
