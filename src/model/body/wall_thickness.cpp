// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "viscera/model/body/wall_thickness.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "math/number_text.h"
#include "model/shape/mesh/triangle_tree.h"

namespace viscera {
namespace {

constexpr size_t kRays = 4000;
/// Least cosine of the angle between a ray and the surface normal where the ray leaves the tissue. Below it, the ray
/// has crossed an edge or a rim and no wall.
constexpr float kFacesBack = 0.5F;
/// Least share of rays that must end on the other side of a wall. In an open surface none does.
constexpr double kLeastShare = 0.1;

struct WallError {
  double cells, bowl, tube;
};
using WallErrors = std::array<WallError, 6>;
/// Errors measured against CalculiX at nu 0.3, with rows at nu 0.45 (`viscera bench walls`; docs/verification.md). From
/// one cell on, the tube's error is assumed to fall as the square of the spacing, and errors above the largest number
/// of cells and below the least one to change so. With rows, the error at three cells is assumed to be half of that at
/// two.
constexpr WallErrors kCellErrors = {{{0.53, 0.315, 0.095},
                                     {0.75, 0.254, 0.056},
                                     {1, 0.174, 0.036},
                                     {1.5, 0.104, 0.016},
                                     {2, 0.063, 0.009},
                                     {3, 0.022, 0.004}}};
constexpr WallErrors kRowErrors = {{{0.53, 0.052, 0.052},
                                    {0.75, 0.049, 0.025},
                                    {1, 0.026, 0.007},
                                    {1.5, 0.025, 0.003},
                                    {2, 0.021, 0.002},
                                    {3, 0.01, 0.001}}};

struct Ray {
  Vector3f from_m, inward;
};
/// Returns rays from the centres of triangles, evenly over their area.
std::vector<Ray> raysOf(const TriangleMesh& mesh) {
  std::vector<double> until(mesh.triangles.size());
  double area = 0;
  const auto normalOf = [&](const std::array<uint32_t, 3>& t) -> Vector3f {
    const auto& p = mesh.positions_m;
    return (p[t[1]] - p[t[0]]).cross(p[t[2]] - p[t[0]]);
  };
  for (size_t t = 0; t < until.size(); ++t) until[t] = area += static_cast<double>(normalOf(mesh.triangles[t]).norm());
  std::vector<Ray> out;
  size_t t = 0;
  for (size_t i = 0; i < kRays && area > 0; ++i) {
    while (t + 1 < until.size() && until[t] < (static_cast<double>(i) + 0.5) / kRays * area) ++t;
    const std::array<uint32_t, 3>& corners = mesh.triangles[t];
    const auto& p = mesh.positions_m;
    out.push_back({(p[corners[0]] + p[corners[1]] + p[corners[2]]) / 3, -normalOf(corners).normalized()});
  }
  return out;
}

/// Returns the value that a given share of sorted values is below.
double quantile(const std::vector<double>& sorted, double share) {
  return sorted[std::min(static_cast<size_t>(share * static_cast<double>(sorted.size())), sorted.size() - 1)];
}

}  // namespace

std::optional<WallThickness> wallThickness(const Body& body) {
  const TriangleMesh& mesh = body.skin.mesh;
  if (!body.hasCells() || mesh.triangles.empty()) return std::nullopt;
  const TriangleTree tree(mesh);
  std::vector<double> found_m;
  for (const Ray& ray : raysOf(mesh)) {
    const MeshPoint position = tree.ahead(ray.from_m, ray.inward);
    if (!position.found()) continue;
    const std::array<uint32_t, 3>& t = mesh.triangles[position.triangle];
    const auto& p = mesh.positions_m;
    const Vector3f normal = (p[t[1]] - p[t[0]]).cross(p[t[2]] - p[t[0]]).normalized();
    if (normal.dot(ray.inward) >= kFacesBack) found_m.push_back(static_cast<double>(position.distance_m));
  }
  if (static_cast<double>(found_m.size()) < kLeastShare * kRays) return std::nullopt;
  std::sort(found_m.begin(), found_m.end());
  return WallThickness{quantile(found_m, 0.01), quantile(found_m, 0.1), quantile(found_m, 0.5)};
}

WallErrorRange expectedWallError(double cells, Walls walls) {
  const WallErrors& errors = walls == Walls::kRows ? kRowErrors : kCellErrors;
  if (cells <= errors.front().cells || cells >= errors.back().cells) {
    const WallError& known = cells <= errors.front().cells ? errors.front() : errors.back();
    const double coarser = std::pow(known.cells / cells, 2);
    return {std::min(1.0, known.tube * coarser), std::min(1.0, known.bowl * coarser)};
  }
  size_t i = 1;
  while (errors[i].cells < cells) ++i;
  const WallError &a = errors[i - 1], &b = errors[i];
  const auto between = [&](double of_a, double of_b) {
    return std::clamp(of_a + (cells - a.cells) / (b.cells - a.cells) * (of_b - of_a), 0.0, 1.0);
  };
  return {between(a.tube, b.tube), between(a.bowl, b.bowl)};
}

double cellsForWallError(double error, Walls walls) {
  double low = 0, high = 1e3;
  while (high - low > 1e-6 * high) {
    const double middle = 0.5 * (low + high);
    (expectedWallError(middle, walls).most > error ? low : high) = middle;
  }
  return high;
}

std::string wallThicknessText(const WallThickness& thickness, double spacing_m, Walls walls) {
  TextOut out;
  out.precision(3);
  const auto add = [&](const char* which, double thickness_m) {
    out << which << thickness_m * 1e3 << " mm (" << thickness_m / spacing_m << " cells)";
  };
  add("walls: thinnest ", thickness.least_m);
  add(", 10 % below ", thickness.tenth_m);
  add(", median ", thickness.median_m);
  const double cells = thickness.tenth_m / spacing_m;
  const WallErrorRange error = expectedWallError(cells, walls);
  out.precision(2);
  out << "; walls of " << cells << " cells are " << 100 * error.least << " % (a tube) to " << 100 * error.most
      << " % (an open bowl) too stiff in bending";
  if (error.most <= kNotedWallError) return out.str();
  if (walls == Walls::kCells)
    out << ", at most " << 100 * expectedWallError(cells, Walls::kRows).most << " % with material.walls: rows";
  out.precision(3);
  out << "; at spacing_m " << thickness.tenth_m / cellsForWallError(kNotedWallError, walls) << " at most "
      << 100 * kNotedWallError << " %";
  return out.str();
}

}  // namespace viscera
