// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <string>
#include <vector>

#include "viscera/math/types.h"

namespace viscera::cli {

using Rgb = std::array<uint8_t, 3>;

/// A picture that is drawn without OpenGL: pixels, lines, triangles with depth, a few letters. y goes down.
class PreviewCanvas {
 public:
  PreviewCanvas(int width, int height);

  int width() const { return width_; }
  int height() const { return height_; }
  /// Outside of the picture nothing is drawn.
  void pixel(int x, int y, const Rgb& color);
  void line(const Eigen::Vector2d& from, const Eigen::Vector2d& to, const Rgb& color);
  /// @param corners  pixels, and in z how near: the nearest one drawn so far stays
  void triangle(const std::array<Vector3d, 3>& corners, const Rgb& color);
  /// Where left, right, top and bottom of the picture lead to: one of A, P, L, R, S, I each.
  void letters(char left, char right, char top, char bottom);
  void write(const std::string& path) const;  ///< as PNG   @throws ImageError

 private:
  void letter(char name, int left, int top);

  int width_, height_;
  std::vector<uint8_t> rgb_;
  std::vector<float> near_;  ///< [pixels] of what triangles drew; empty: none
};

}  // namespace viscera::cli
