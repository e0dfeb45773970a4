// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "surface/part_colors.h"

#include <algorithm>
#include <cmath>

namespace viscera {

namespace {

// Multiples of the plastic number's powers spread over the square without clusters.
constexpr double kShadeStep = 0.7548776662466927;
constexpr double kTintStep = 0.5698402909980532;
constexpr double kShadeRange = 0.16;  // lightness of parts differs by at most +-16 %
constexpr double kTintRange = 0.10;   // red against blue by at most +-10 %
constexpr uint16_t kNoPart = UINT16_MAX;

/// The part's place in a sequence that fills -1..1 evenly; part 0 is at 0.
double spread(double step, size_t part) {
  const double turns = step * static_cast<double>(part) + 0.5;
  return 2 * (turns - std::floor(turns)) - 1;
}

uint32_t rgba8(const Vector3d& color, bool two_sided) {
  uint32_t packed = two_sided ? 0u : 255u << 24;
  for (int c = 0; c < 3; ++c) {
    packed |= static_cast<uint32_t>(std::lround(255 * std::clamp(color[c], 0.0, 1.0))) << (8 * c);
  }
  return packed;
}

}  // namespace

Vector3d partColor(const Vector3d& organ_color, size_t part) {
  const double shade = 1 + kShadeRange * spread(kShadeStep, part);
  const double tint = kTintRange * spread(kTintStep, part);
  const Vector3d color = shade * organ_color.cwiseProduct(Vector3d(1 + tint, 1, 1 - tint));
  return color.cwiseMax(0.0).cwiseMin(1.0);
}

std::vector<uint32_t> vertexColors(const TriangleMesh& mesh, const Vector3d& organ_color, bool two_sided) {
  std::vector<uint16_t> parts(mesh.positions_m.size(), kNoPart);
  for (size_t t = 0; t < mesh.triangles.size(); ++t) {
    for (uint32_t v : mesh.triangles[t]) parts[v] = std::min(parts[v], mesh.parts[t]);
  }
  std::vector<uint32_t> colors;
  colors.reserve(parts.size());
  for (uint16_t part : parts) {
    colors.push_back(rgba8(partColor(organ_color, part == kNoPart ? 0 : part), two_sided));
  }
  return colors;
}

}  // namespace viscera
