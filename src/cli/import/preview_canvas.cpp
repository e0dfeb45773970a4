// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "cli/import/preview_canvas.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "export/png_writer.h"

namespace viscera::cli {
namespace {

constexpr int kLetterWidth = 5, kLetterHeight = 7;  ///< [dots]
constexpr int kDot = 2;                             ///< [pixels]
constexpr int kFromEdge = 6;                        ///< [pixels]
constexpr Rgb kLetterColor = {255, 255, 255};

/// Returns the rows of a letter from the top, with the leftmost dot in the highest of five bits.
std::array<uint8_t, kLetterHeight> rowsOf(char name) {
  switch (name) {
    case 'A':
      return {14, 17, 17, 31, 17, 17, 17};
    case 'P':
      return {30, 17, 17, 30, 16, 16, 16};
    case 'L':
      return {16, 16, 16, 16, 16, 16, 31};
    case 'R':
      return {30, 17, 17, 30, 20, 18, 17};
    case 'S':
      return {15, 16, 16, 14, 1, 1, 30};
    default:
      return {14, 4, 4, 4, 4, 4, 14};  // for I
  }
}

}  // namespace

PreviewCanvas::PreviewCanvas(int width, int height)
    : width_(width), height_(height), rgb_(3 * static_cast<size_t>(width) * static_cast<size_t>(height), 16) {}

void PreviewCanvas::pixel(int x, int y, const Rgb& color) {
  if (x < 0 || y < 0 || x >= width_ || y >= height_) return;
  std::copy(color.begin(), color.end(), rgb_.begin() + 3 * (static_cast<std::ptrdiff_t>(y) * width_ + x));
}

void PreviewCanvas::line(const Eigen::Vector2d& from, const Eigen::Vector2d& to, const Rgb& color) {
  const int steps = std::max(1, static_cast<int>(std::ceil((to - from).cwiseAbs().maxCoeff())));
  for (int n = 0; n <= steps; ++n) {
    const Eigen::Vector2d at = from + (to - from) * n / steps;
    pixel(static_cast<int>(std::floor(at.x())), static_cast<int>(std::floor(at.y())), color);
  }
}

void PreviewCanvas::triangle(const std::array<Vector3d, 3>& c, const Rgb& color) {
  if (near_.empty()) near_.assign(rgb_.size() / 3, -std::numeric_limits<float>::infinity());
  const auto cross = [](const Vector3d& a, const Vector3d& b, double x, double y) {
    return (b.x() - a.x()) * (y - a.y()) - (b.y() - a.y()) * (x - a.x());
  };
  const double area = cross(c[0], c[1], c[2].x(), c[2].y());
  if (area == 0) return;
  const Vector3d low = c[0].cwiseMin(c[1]).cwiseMin(c[2]), high = c[0].cwiseMax(c[1]).cwiseMax(c[2]);
  for (int y = std::max(0, static_cast<int>(low.y())); y <= std::min<double>(height_ - 1, high.y()); ++y)
    for (int x = std::max(0, static_cast<int>(low.x())); x <= std::min<double>(width_ - 1, high.x()); ++x) {
      const double a = cross(c[1], c[2], x + 0.5, y + 0.5) / area, b = cross(c[2], c[0], x + 0.5, y + 0.5) / area;
      if (a < 0 || b < 0 || a + b > 1) continue;
      const auto depth = static_cast<float>(a * c[0].z() + b * c[1].z() + (1 - a - b) * c[2].z());
      float& nearest = near_[static_cast<size_t>(y) * static_cast<size_t>(width_) + static_cast<size_t>(x)];
      if (depth <= nearest) continue;
      nearest = depth;
      pixel(x, y, color);
    }
}

void PreviewCanvas::letter(char name, int left, int top) {
  const auto rows = rowsOf(name);
  for (int y = 0; y < kLetterHeight * kDot; ++y)
    for (int x = 0; x < kLetterWidth * kDot; ++x)
      if (rows[static_cast<size_t>(y / kDot)] >> (kLetterWidth - 1 - x / kDot) & 1)
        pixel(left + x, top + y, kLetterColor);
}

void PreviewCanvas::letters(char left, char right, char top, char bottom) {
  const int wide = kLetterWidth * kDot, tall = kLetterHeight * kDot;
  letter(left, kFromEdge, (height_ - tall) / 2);
  letter(right, width_ - kFromEdge - wide, (height_ - tall) / 2);
  letter(top, (width_ - wide) / 2, kFromEdge);
  letter(bottom, (width_ - wide) / 2, height_ - kFromEdge - tall);
}

void PreviewCanvas::write(const std::string& path) const {
  writePng(path, width_, height_, rgb_);
}

}  // namespace viscera::cli
