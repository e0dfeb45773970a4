// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <string>
#include <vector>

#include "viscera/math/types.h"

namespace viscera::cli {

using Rgb = std::array<uint8_t, 3>;

/// An image drawn without OpenGL: pixels, lines, triangles with depth, a few letters. y points down.
class PreviewCanvas {
 public:
  PreviewCanvas(int width, int height);

  int width() const { return width_; }
  int height() const { return height_; }
  /// Sets a pixel; does nothing outside the image.
  void pixel(int x, int y, const Rgb& color);
  void line(const Eigen::Vector2d& from, const Eigen::Vector2d& to, const Rgb& color);
  /// Draws a triangle. @param corners  [pixels], with z towards the viewer: the nearest triangle is visible
  void triangle(const std::array<Vector3d, 3>& corners, const Rgb& color);
  /// Draws the directions of the left, right, top and bottom edges: one of A, P, L, R, S, I each.
  void letters(char left, char right, char top, char bottom);
  void write(const std::string& path) const;  ///< writes a PNG   @throws ImageError

 private:
  void letter(char name, int left, int top);

  int width_, height_;
  std::vector<uint8_t> rgb_;
  std::vector<float> near_;  ///< [pixels] depth of triangles; empty: none
};

}  // namespace viscera::cli
