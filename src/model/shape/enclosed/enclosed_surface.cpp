// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "model/shape/enclosed/enclosed_surface.h"

#include <algorithm>
#include <cmath>

#include "math/number_text.h"
#include "model/scan/net_cells.h"
#include "model/shape/enclosed/patch_grid.h"
#include "viscera/math/error.h"

namespace viscera {
namespace {

/// Half the diagonal of a cell, in steps: a flood with less passes through walls.
constexpr double kLeastRadius = 0.87;
constexpr double kBeyond = 0.6;  ///< in steps: distance of the flood beyond the closing radius, up to the triangles
constexpr double kOnward =
    0.25;  ///< in steps: each step must lead this much away from the flood, so that leaks through a gap do not spread
/// Relative difference of volumes that count as equal: hollows that close, not holes.
constexpr double kSettled = 0.005;

/// Enlarges the step until the grid has few enough points, and reports the gap that would have allowed the requested
/// step.
void chooseStep(const TriangleMesh& mesh, double gap_m, EnclosedSurface& found) {
  Eigen::AlignedBox3d box;
  for (const auto& t : mesh.triangles) {
    for (const uint32_t v : t) box.extend(mesh.positions_m[v].cast<double>());
  }
  const auto fits = [&](double h, double gap) {
    return ((box.sizes().array() + gap) / h + 6).prod() <= found.most_points;
  };
  found.step_m = found.asked_step_m;
  while (!fits(found.step_m, gap_m)) found.step_m *= 1.05;
  double most = gap_m;
  constexpr double kSmaller = 0.95, kLeastShare = 0.01;  // share of gap_m: precise enough for a message
  while (most > kLeastShare * gap_m && !fits(found.asked_step_m, most)) most *= kSmaller;
  found.fine_gap_m = fits(found.asked_step_m, most) ? most : -1;
}

class Flood {
 public:
  explicit Flood(const PatchGrid& grid) : grid_(grid) {}

  /// Returns which points are outside [points], with gaps of up to twice the radius closed.
  std::vector<uint8_t> outside(double radius_m) const {
    std::vector<uint8_t> out(grid_.points(), 0);
    std::vector<size_t> front = {0};
    out[0] = 1;
    spread(out, front, [&](size_t, size_t, size_t to, int) { return grid_.distances_m[to] > radius_m; });
    // Continue to the triangles, but no farther than the radius into a gap.
    const std::vector<float> distance = distancesTo(out, grid_);
    const double most = radius_m / grid_.step_m + kBeyond;
    for (size_t i = 0; i < out.size(); ++i) {
      if (out[i]) front.push_back(i);
    }
    spread(out, front, [&](size_t from, size_t lower, size_t to, int axis) {
      return distance[to] <= most && distance[to] >= distance[from] + kOnward && !grid_.crossed(lower, axis);
    });
    return out;
  }

 private:
  /// @param passes  (start point, lower point of the edge, end point, axis)
  template <class Passes>
  void spread(std::vector<uint8_t>& out, std::vector<size_t>& front, Passes passes) const {
    while (!front.empty()) {
      const size_t from = front.back();
      front.pop_back();
      for (int axis = 0; axis < 3; ++axis) {
        const size_t stride = grid_.stride(axis);
        const int at = grid_.along(from, axis);
        if (at > 0) reach(out, front, from, from - stride, from - stride, axis, passes);
        if (at + 1 < grid_.size[axis]) reach(out, front, from, from, from + stride, axis, passes);
      }
    }
  }

  template <class Passes>
  static void reach(std::vector<uint8_t>& out, std::vector<size_t>& front, size_t from, size_t lower, size_t to,
                    int axis, Passes passes) {
    if (out[to] || !passes(from, lower, to, axis)) return;
    out[to] = 1;
    front.push_back(to);
  }

  const PatchGrid& grid_;
};

/// Returns the volume along grid lines, between the outermost triangles; without triangles the border is half way.
double volumeOf(const std::vector<uint8_t>& out, const PatchGrid& grid) {
  double steps = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const size_t stride = grid.stride(axis);
    for (size_t i = 0; i + stride < out.size(); ++i) {
      if (grid.along(i, axis) + 1 >= grid.size[axis] || (out[i] && out[i + stride])) continue;
      if (!out[i] && !out[i + stride]) {
        steps += 1;
      } else {
        const auto [first, last] = grid.crossings(i, axis);
        steps += out[i] ? 1 - first : last;
      }
    }
  }
  return steps / 3 * std::pow(grid.step_m, 3);
}

TriangleMesh surfaceOf(const std::vector<uint8_t>& out, const PatchGrid& grid) {
  LabelVolume volume;
  volume.frame.size = grid.size;
  volume.frame.axes *= grid.step_m;
  volume.frame.origin = grid.origin_m;
  volume.labels.resize(out.size());
  for (size_t i = 0; i < out.size(); ++i) volume.labels[i] = !out[i];
  const SurfaceNet net = plainNet(volume, [&](const Vector3i& point, int axis) -> double {
    const size_t i = point.x() + grid.stride(1) * point.y() + grid.stride(2) * point.z();
    const auto [first, last] = grid.crossings(i, axis);
    return out[i] ? first : last;
  });
  return labelSurfaces(net, {{0, ""}, {1, "enclosed"}}, {1});
}

}  // namespace

std::string EnclosedSurface::text() const {
  TextOut text;
  text << "encloses " << volume_m3 * 1e6 << " cm3; gaps up to " << closed_gap_m * 1e3 << " mm are closed";
  if (hole_m > 0) text << "; it has a hole of about " << hole_m * 1e3 << " mm";
  if (!settled) text << "; wider gaps may still be open: see gap_m";
  if (step_m > asked_step_m) {
    text << "; found on a grid of " << step_m * 1e3 << " mm, coarser than the " << asked_step_m * 1e3
         << " mm for this spacing, which would have more than " << most_points / 1e6
         << " million points, so finer shapes are lost; ";
    if (fine_gap_m >= 0)
      text << "gap_m of at most " << fine_gap_m << " m keeps the finer grid";
    else
      text << "a spacing_m " << step_m / asked_step_m << " times as large matches this grid";
  }
  return text.str();
}

EnclosedSurface enclosedSurface(const TriangleMesh& mesh, double step_m, double gap_m, double most_points) {
  if (mesh.triangles.empty()) throw MeshError("the mesh encloses no volume: it has no triangles");
  EnclosedSurface found;
  found.asked_step_m = step_m;
  found.most_points = most_points;
  chooseStep(mesh, gap_m, found);
  const double step = found.step_m;
  const double least_m = kLeastRadius * step, most_m = std::max(least_m, gap_m / 2);
  const PatchGrid grid(mesh, step, most_m + 2 * step);
  const Flood flood(grid);
  std::vector<uint8_t> kept;
  double before_m3 = -1;
  for (double radius_m = least_m;; radius_m = std::min(2 * radius_m, most_m)) {
    std::vector<uint8_t> out = flood.outside(radius_m);
    const double volume_m3 = volumeOf(out, grid);
    const bool jumped = volume_m3 - before_m3 > kSettled * volume_m3;
    if (before_m3 < 0 || jumped) {  // the smallest radius above which nothing more is found
      kept = std::move(out);
      found.volume_m3 = volume_m3;
      if (before_m3 >= 0)
        found.hole_m = found.closed_gap_m = 2 * radius_m;
      else
        found.closed_gap_m = 2 * radius_m;
    }
    before_m3 = volume_m3;
    if (radius_m >= most_m) {
      found.settled = !jumped || found.hole_m == 0;
      break;
    }
  }
  found.mesh = surfaceOf(kept, grid);
  if (found.mesh.triangles.empty()) {
    TextOut why;
    why << "the mesh encloses no volume, even with gaps up to " << 2e3 * most_m
        << " mm closed; raise gap_m or the spacing";
    throw MeshError(why.str());
  }
  return found;
}

}  // namespace viscera
