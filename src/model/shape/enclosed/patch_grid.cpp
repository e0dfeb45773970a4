// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "model/shape/enclosed/patch_grid.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace viscera {
namespace {

constexpr float kFar = std::numeric_limits<float>::max();
constexpr double kBand = 1.5;     ///< in steps: within it distances to triangles are exact
constexpr double kNear = 0.87;    ///< in steps: half the diagonal of a cell of the grid
constexpr double kOfNear = 0.45;  ///< in steps: average distance from the triangle of points within kNear

double distanceToSegment(const Vector3d& p, const Vector3d& a, const Vector3d& b) {
  const Vector3d along = b - a;
  const double length2 = along.squaredNorm();
  const double t = length2 > 0 ? std::clamp((p - a).dot(along) / length2, 0.0, 1.0) : 0.0;
  return (p - a - t * along).norm();
}

double distanceTo(const Vector3d& p, const std::array<Vector3d, 3>& t) {
  const Vector3d n = (t[1] - t[0]).cross(t[2] - t[0]);
  const double n2 = n.squaredNorm();
  bool above = n2 > 0;
  for (int c = 0; c < 3 && above; ++c) above = n.cross(t[(c + 1) % 3] - t[c]).dot(p - t[c]) >= 0;
  if (above) return std::abs(n.dot(p - t[0])) / std::sqrt(n2);
  return std::min(
      {distanceToSegment(p, t[0], t[1]), distanceToSegment(p, t[1], t[2]), distanceToSegment(p, t[2], t[0])});
}

/// Lower envelope along a line: replaces squared distances by the minimum of value + distance^2 over all of its points.
class LineEnvelope {
 public:
  explicit LineEnvelope(int most) : values_(most), borders_(most + 1), tops_(most) {}

  void apply(float* first, size_t stride, int count) {
    for (int i = 0; i < count; ++i) values_[i] = first[i * stride];
    int top = -1;
    for (int i = 0; i < count; ++i) {
      if (values_[i] >= kFar) continue;
      double border = -std::numeric_limits<double>::infinity();
      while (top >= 0) {
        const double k = tops_[top];
        border = ((values_[i] + double(i) * i) - (values_[tops_[top]] + k * k)) / (2 * (i - k));
        if (border > borders_[top]) break;
        --top;
      }
      if (top < 0) border = -std::numeric_limits<double>::infinity();
      tops_[++top] = i;
      borders_[top] = border;
      borders_[top + 1] = std::numeric_limits<double>::infinity();
    }
    if (top < 0) return;
    for (int i = 0, k = 0; i < count; ++i) {
      while (borders_[k + 1] < i) ++k;
      const double offset = i - tops_[k];
      first[i * stride] = static_cast<float>(values_[tops_[k]] + offset * offset);
    }
  }

 private:
  std::vector<double> values_, borders_;
  std::vector<int> tops_;
};

}  // namespace

PatchGrid::PatchGrid(const TriangleMesh& mesh, double step, double reach_m) : step_m(step) {
  Eigen::AlignedBox3d box;
  for (const auto& t : mesh.triangles) {
    for (const uint32_t v : t) box.extend(mesh.positions_m[v].cast<double>());
  }
  const double room_m = reach_m + 2 * step_m;
  origin_m = box.min() - Vector3d::Constant(room_m);
  size = ((box.sizes().array() + 2 * room_m) / step_m).ceil().cast<int>() + 1;
  distances_m.assign(static_cast<size_t>(size.x()) * size.y() * size.z(), kFar);
  crossed_.assign(distances_m.size(), 0);
  for (const auto& t : mesh.triangles) {
    std::array<Vector3d, 3> corners;
    for (int c = 0; c < 3; ++c) corners[c] = (mesh.positions_m[t[c]].cast<double>() - origin_m) / step_m;
    addDistances(corners);
    for (int axis = 0; axis < 3; ++axis) addCrossings(corners, axis);
  }
  goOn();
  for (float& d : distances_m) d = static_cast<float>(d * step_m);
}

void PatchGrid::addDistances(const std::array<Vector3d, 3>& corners) {
  const Vector3d low = corners[0].cwiseMin(corners[1]).cwiseMin(corners[2]).array() - kBand;
  const Vector3d high = corners[0].cwiseMax(corners[1]).cwiseMax(corners[2]).array() + kBand;
  const Vector3i first = low.array().ceil().cast<int>().max(0);
  const Vector3i last = high.array().floor().cast<int>().min(size.array() - 1);
  for (int k = first.z(); k <= last.z(); ++k) {
    for (int j = first.y(); j <= last.y(); ++j) {
      for (int i = first.x(); i <= last.x(); ++i) {
        float& d = distances_m[i + stride(1) * j + stride(2) * k];
        d = std::min(d, static_cast<float>(distanceTo(Vector3d(i, j, k), corners)));
      }
    }
  }
}

void PatchGrid::addCrossings(const std::array<Vector3d, 3>& p, int axis) {
  // Steps by which all points are shifted against the triangles: on faces along the grid all edges then agree on the
  // inside.
  constexpr double kAside[3] = {1e-7, 2e-7, 3e-7};
  constexpr double kOnEdge = -1e-9;  // shares of a triangle: no line slips between two of them
  const int u = (axis + 1) % 3, v = (axis + 2) % 3;
  const auto cross = [](double au, double av, double bu, double bv) { return au * bv - av * bu; };
  const double area = cross(p[1][u] - p[0][u], p[1][v] - p[0][v], p[2][u] - p[0][u], p[2][v] - p[0][v]);
  if (area == 0) return;
  const auto range = [&](int a) {
    const auto [low, high] = std::minmax({p[0][a], p[1][a], p[2][a]});
    return std::pair(static_cast<int>(std::ceil(low - 1e-6)), static_cast<int>(std::floor(high)));
  };
  const auto [first_u, last_u] = range(u);
  const auto [first_v, last_v] = range(v);
  for (int b = first_v; b <= last_v; ++b) {
    for (int a = first_u; a <= last_u; ++a) {
      const double at_u = a + kAside[u], at_v = b + kAside[v];
      double weight[3], position = 0;
      for (int c = 0; c < 3; ++c) {
        const Vector3d &q = p[(c + 1) % 3], &r = p[(c + 2) % 3];
        weight[c] = cross(q[u] - at_u, q[v] - at_v, r[u] - at_u, r[v] - at_v) / area;
        position += weight[c] * p[c][axis];
      }
      if (weight[0] < kOnEdge || weight[1] < kOnEdge || weight[2] < kOnEdge) continue;
      const int i = static_cast<int>(std::floor(position - kAside[axis]));
      if (i < 0 || i + 1 >= size[axis]) continue;
      const size_t point = i * stride(axis) + a * stride(u) + b * stride(v);
      const auto share = static_cast<float>(position - i);
      auto& [low, high] = where_.try_emplace(3 * point + axis, std::array<float, 2>{share, share}).first->second;
      low = std::min(low, share);
      high = std::max(high, share);
      crossed_[point] |= static_cast<uint8_t>(1 << axis);
    }
  }
}

/// Extends distances beyond the band, from the points next to triangles.
void PatchGrid::goOn() {
  std::vector<uint8_t> beside(points());
  for (size_t i = 0; i < points(); ++i) beside[i] = distances_m[i] < kNear;
  const std::vector<float> on = distancesTo(beside, *this);
  for (size_t i = 0; i < points(); ++i) {
    if (distances_m[i] >= kFar) distances_m[i] = on[i] + static_cast<float>(kOfNear);
  }
}

std::array<float, 2> PatchGrid::crossings(size_t point, int axis) const {
  const auto found = crossed(point, axis) ? where_.find(3 * point + axis) : where_.end();
  return found == where_.end() ? std::array<float, 2>{0.5f, 0.5f} : found->second;
}

std::vector<float> distancesTo(const std::vector<uint8_t>& marked, const PatchGrid& grid) {
  std::vector<float> d(marked.size());
  for (size_t i = 0; i < d.size(); ++i) d[i] = marked[i] ? 0 : kFar;
  LineEnvelope line(grid.size.maxCoeff());
  for (int axis = 0; axis < 3; ++axis) {
    for (size_t i = 0; i < d.size(); ++i) {
      if (grid.along(i, axis) == 0) line.apply(&d[i], grid.stride(axis), grid.size[axis]);
    }
  }
  for (float& x : d) x = x >= kFar ? kFar : std::sqrt(x);
  return d;
}

}  // namespace viscera
