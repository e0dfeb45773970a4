// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// over.frag - the mean of the four samples per pixel that were drawn over the tissue: colour times alpha, and alpha.
// Owner: render/deferred_lighting.h
#include "layout.h"
#include "layout/seen.h"

uniform vec2 texel;  // see pixel_classes.frag
layout(binding = kUnitOver) uniform sampler2D over;
layout(location = 0) out vec4 image;

void main() { image = texture(over, 2.0 * gl_FragCoord.xy * texel); }
