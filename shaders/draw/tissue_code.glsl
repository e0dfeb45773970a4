// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// tissue_code.glsl - decoding of the alpha of a body's vertices (surface/skins/part_colors.h): body, and wall or
// surface.
int bodyOf(float alpha) {
  int code = int(alpha * 255.0 + 0.5);
  return code >= 240 ? 255 - code : code >= 160 ? code - 160 : code;
}

bool isWall(float alpha) { return alpha > 0.55 && alpha < 0.75; }

const float kTurnedAway = 0.2;  // a wall's smooth normal is used above this cosine to the line of sight
