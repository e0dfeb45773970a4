// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// overlay_line.frag - a line of one colour.   Owner: render/overlay_painter.h
in vec3 position_m;
in vec3 normal;
in vec4 color;
layout(location = 0) out vec4 image;

void main() { image = color; }
