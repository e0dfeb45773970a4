// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// tissue_code.glsl - what the alpha of a body's vertices says (surface/skins/part_colors.h): whose, and wall or skin.
int bodyOf(float alpha) {
  int code = int(alpha * 255.0 + 0.5);
  return code >= 240 ? 255 - code : code >= 160 ? code - 160 : code;
}

bool isWall(float alpha) { return alpha > 0.55 && alpha < 0.75; }

const float kTurnedAway = 0.2;  // cosine between a wall's smooth normal and the line of sight below which it is not taken
