// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// whole.vert - one triangle over the whole image, at one depth.   Owner: render/deferred_lighting.h
uniform float clip_depth;

void main() { gl_Position = vec4(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0, clip_depth, 1.0); }
