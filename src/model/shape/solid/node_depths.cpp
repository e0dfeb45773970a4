// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "model/shape/solid/node_depths.h"

#include <algorithm>
#include <cmath>

#include "math/in_parallel.h"

namespace viscera {
namespace {

/// Returns the nodes of labelled cells that are not surrounded by full cells, ascending, not yet measured.
std::vector<NodeDepth> nodesAtSurface(const Solid& solid) {
  std::vector<bool> is_full(solid.labels.size());
  for (size_t i = 0; i < is_full.size(); ++i) is_full[i] = solid.labels[i] != 0;
  for (const PartialCell& p : solid.partial) is_full[p.cell] = false;
  const Vector3i& n = solid.cells;
  std::vector<NodeDepth> nodes;
  for (int z = 0; z <= n.z(); ++z) {
    for (int y = 0; y <= n.y(); ++y) {
      for (int x = 0; x <= n.x(); ++x) {
        int labelled = 0, full = 0;
        for (int c = 0; c < 8; ++c) {
          const Vector3i cell(x - (c & 1), y - (c >> 1 & 1), z - (c >> 2));
          if (solid.label(cell.x(), cell.y(), cell.z()) == 0) continue;
          ++labelled;
          full += is_full[solid.index(cell.x(), cell.y(), cell.z())] ? 1 : 0;
        }
        if (labelled > 0 && full < 8) nodes.push_back({{x, y, z}, 0, Eigen::Vector3f::Zero()});
      }
    }
  }
  return nodes;
}

/// Returns the vector from p to the nearest point of a triangle.
Vector3d offsetTo(const std::array<Vector3d, 3>& t, const Vector3d& p) {
  const Vector3d normal = (t[1] - t[0]).cross(t[2] - t[0]);
  bool above = normal.squaredNorm() > 0;
  for (int e = 0; e < 3 && above; ++e) {
    const Vector3d &a = t[e], &b = t[(e + 1) % 3];
    above = normal.cross(b - a).dot(p - a) >= 0;
  }
  if (above) return (t[0] - p).dot(normal) / normal.squaredNorm() * normal;
  Vector3d least = t[0] - p;
  for (int e = 0; e < 3; ++e) {
    const Vector3d &a = t[e], edge = t[(e + 1) % 3] - a;
    const double length2 = edge.squaredNorm();
    const double at = length2 > 0 ? std::clamp((p - a).dot(edge) / length2, 0.0, 1.0) : 0;
    const Vector3d offset = a + at * edge - p;
    if (offset.squaredNorm() < least.squaredNorm()) least = offset;
  }
  return least;
}

/// Distances from nodes to triangles, in cells.
class NodeDistances {
 public:
  NodeDistances(const Solid& solid, const std::vector<NodeDepth>& nodes)
      : solid_(solid),
        per_axis_(solid.cells.array() + 1),
        index_(static_cast<size_t>(per_axis_.cast<int64_t>().prod()), 0),
        offsets(nodes.size(), Vector3d(kReach, 0, 0)),
        is_inside(nodes.size(), false) {
    for (size_t i = 0; i < nodes.size(); ++i) index_[flat(nodes[i].node)] = static_cast<uint32_t>(i + 1);
  }

  void meet(const Shell& shell) {
    for (const auto& t : shell.triangles) {
      std::array<Vector3d, 3> triangle;
      for (int c = 0; c < 3; ++c) {
        triangle[c] = (shell.positions_m[t[c]] - solid_.origin_m) / solid_.spacing_m;
      }
      meet(triangle);
    }
    Solid around = solid_;  // nodes are the centres of its cells
    around.labels.clear();
    around.partial.clear();
    around.origin_m -= Vector3d::Constant(0.5 * solid_.spacing_m);
    around.cells = per_axis_;
    for (const InsideStretch& s : insideStretches(shell, around, 0)) {
      const auto [first, last] = centresWithin(s, per_axis_.x());
      for (int x = first; x < last; ++x) {
        if (const uint32_t known = index_[flat({x, s.column_u, s.column_v})]) is_inside[known - 1] = true;
      }
    }
  }

 private:
  static constexpr double kReach = 2;  ///< in cells: a cell's diagonal and a margin

  size_t flat(const Vector3i& node) const {
    return static_cast<size_t>(node.x()) +
           static_cast<size_t>(per_axis_.x()) * (node.y() + static_cast<size_t>(per_axis_.y()) * node.z());
  }

  void meet(const std::array<Vector3d, 3>& t) {
    const Vector3d low_corner = t[0].cwiseMin(t[1]).cwiseMin(t[2]), high_corner = t[0].cwiseMax(t[1]).cwiseMax(t[2]);
    const Vector3i low = (low_corner.array() - kReach).ceil().max(0.0).cast<int>();
    const Vector3i high = (high_corner.array() + kReach).floor().min(per_axis_.cast<double>().array() - 1).cast<int>();
    const Vector3d normal = (t[1] - t[0]).cross(t[2] - t[0]);
    const double length2 = normal.squaredNorm();
    for (int z = low.z(); z <= high.z(); ++z) {
      for (int y = low.y(); y <= high.y(); ++y) {
        for (int x = low.x(); x <= high.x(); ++x) {
          const uint32_t known = index_[flat({x, y, z})];
          if (known == 0) continue;
          Vector3d& best = offsets[known - 1];
          const Vector3d p(x, y, z);
          // Its plane is too far away.
          if (std::pow((p - t[0]).dot(normal), 2) >= best.squaredNorm() * length2) continue;
          const Vector3d offset = offsetTo(t, p);
          if (offset.squaredNorm() < best.squaredNorm()) best = offset;
        }
      }
    }
  }

  const Solid& solid_;
  Vector3i per_axis_;
  std::vector<uint32_t> index_;  ///< [nodes of the grid] 0, or 1 + index into nodes

 public:
  std::vector<Vector3d> offsets;  ///< vectors to the nearest triangle
  std::vector<bool> is_inside;
};

/// Returns the unit vector of steepest ascent of the distance; 0 where its gradient is zero.
Vector3d outwards(const DistanceField& field, const Vector3d& position_m, double spacing_m) {
  const double step_m = 1e-3 * spacing_m;
  Vector3d out;
  for (int axis = 0; axis < 3; ++axis) {
    const Vector3d step = step_m * Vector3d::Unit(axis);
    out[axis] = field(position_m + step).distance_m - field(position_m - step).distance_m;
  }
  return out.norm() > 0 ? Vector3d(out.normalized()) : out;
}

void measureDepth(const DistanceField& field, const Solid& solid, NodeDepth& n) {
  const Vector3d position_m = solid.origin_m + solid.spacing_m * n.node.cast<double>();
  const double distance_m = field(position_m).distance_m;
  n.depth_m = static_cast<float>(-distance_m);
  if (distance_m > 0) n.offset_m = (-distance_m * outwards(field, position_m, solid.spacing_m)).cast<float>();
}

}  // namespace

void measureDepths(const std::vector<Volume>& volumes, Solid& solid) {
  solid.depths = nodesAtSurface(solid);
  NodeDistances distances(solid, solid.depths);
  for (const Volume& volume : volumes) distances.meet(volume.shell);
  for (size_t i = 0; i < solid.depths.size(); ++i) {
    const Vector3d offset_m = solid.spacing_m * distances.offsets[i];
    solid.depths[i].depth_m = static_cast<float>(distances.is_inside[i] ? offset_m.norm() : -offset_m.norm());
    if (!distances.is_inside[i]) solid.depths[i].offset_m = offset_m.cast<float>();
  }
}

void measureDepths(const DistanceField& field, Solid& solid) {
  solid.depths = nodesAtSurface(solid);
  constexpr size_t kAtOnce = 256;  // nodes per task: a field takes about a microsecond
  inParallel((solid.depths.size() + kAtOnce - 1) / kAtOnce, [&](size_t run) {
    const size_t end = std::min(solid.depths.size(), kAtOnce * (run + 1));
    for (size_t i = kAtOnce * run; i < end; ++i) measureDepth(field, solid, solid.depths[i]);
  });
}

}  // namespace viscera
