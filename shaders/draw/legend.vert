// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// legend.vert - a rectangle of the image.   Owner: render/overlay_painter.h
uniform vec4 position;  // left, top, right, bottom in clip coordinates, where the image's first row is at -1
out vec2 at;         // (0, 0) its upper left corner, (1, 1) its lower right one

void main() {
  at = vec2(float(gl_VertexID & 1), float(gl_VertexID >> 1));
  gl_Position = vec4(mix(position.xy, position.zw, at), 0.0, 1.0);
}
