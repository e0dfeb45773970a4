// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Requirements on wounds (docs/surface.md), as measures of a wounded body in some state.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <random>
#include <set>
#include <utility>
#include <vector>

#include "surface/wound_rig.h"

namespace viscera::testing {

using Position = std::array<int64_t, 3>;
constexpr double kSamePosition_m =
    1e-6;  // rounding of float bindings in a box of 0.1 m is 1e-8; any edge is far longer

inline Position keyOf(const Vector3d& at) {
  return {std::llround(at.x() / kSamePosition_m), std::llround(at.y() / kSamePosition_m),
          std::llround(at.z() / kSamePosition_m)};
}

/// Returns the number of edges, welded by the nodes that carry their ends, without exactly one triangle on either side.
template <class Of>
size_t openEdges(const Of& of, const std::vector<Vector3d>& at) {
  std::map<std::pair<Position, Position>, int> balance;
  const std::vector<uint32_t> triangles = of.triangles();
  for (size_t t = 0; t < triangles.size(); t += 3) {
    for (size_t i = 0; i < 3; ++i) {
      const Position a = keyOf(at[triangles[t + i]]), b = keyOf(at[triangles[t + (i + 1) % 3]]);
      if (a == b) continue;
      if (a < b)
        ++balance[{a, b}];
      else
        --balance[{b, a}];
    }
  }
  size_t open = 0;
  for (const auto& [edge, sum] : balance) open += sum != 0 ? 1 : 0;
  return open;
}

/// Edges of a mesh, by the indices of their vertices.
struct Edges {
  size_t open = 0;    ///< without exactly one triangle on either side
  size_t shared = 0;  ///< with more than two triangles
};
inline Edges edgeCounts(const std::vector<uint32_t>& triangles) {
  std::vector<std::pair<uint64_t, int>> sides;
  for (size_t t = 0; t < triangles.size(); t += 3) {
    for (size_t i = 0; i < 3; ++i) {
      const uint64_t a = triangles[t + i], b = triangles[t + (i + 1) % 3];
      sides.emplace_back(std::min(a, b) << 32U | std::max(a, b), a < b ? 1 : -1);
    }
  }
  std::sort(sides.begin(), sides.end());
  Edges out;
  for (size_t i = 0; i < sides.size();) {
    int sum = 0;
    const size_t first = i;
    for (; i < sides.size() && sides[i].first == sides[first].first; ++i) sum += sides[i].second;
    out.open += sum != 0 ? 1 : 0;
    out.shared += i - first > 2 ? 1 : 0;
  }
  return out;
}

/// Returns the edges of the shown mesh, with walls joined to their vertices of the surface mesh.
inline Edges edgesOf(const Wounded& of) {
  std::vector<uint32_t> triangles = of.triangles();
  for (uint32_t& v : triangles) {
    if (v < of.wound.firstWallVertex()) continue;
    const uint32_t of_skin = of.wound.wallVertices()[v - of.wound.firstWallVertex()].skin_vertex;
    if (of_skin != WoundVertex::kNone) v = of_skin;
  }
  return edgeCounts(triangles);
}

/// Returns the largest distance of walls from their vertices of the surface mesh [m].
inline double seamGap(const Wounded& of, const std::vector<Vector3d>& at) {
  double gap = 0;
  for (size_t v = 0; v < of.wound.wallVertices().size(); ++v) {
    const uint32_t of_skin = of.wound.wallVertices()[v].skin_vertex;
    if (of_skin != WoundVertex::kNone) gap = std::max(gap, (at[of.wound.firstWallVertex() + v] - at[of_skin]).norm());
  }
  return gap;
}

/// Returns for every vertex of a lip the distance to the nearest one of another lip [m]; ascending.
inline std::vector<double> lipGaps(const Wounded& of, const std::vector<Vector3d>& at) {
  std::vector<uint32_t> order;  // along x, for the search for neighbours
  for (size_t v = of.wound.ownVertices(); v < of.wound.firstWallVertex(); ++v) {
    if (!of.wound.isEnd(v)) order.push_back(static_cast<uint32_t>(v));
  }
  std::sort(order.begin(), order.end(), [&](uint32_t a, uint32_t b) { return at[a].x() < at[b].x(); });
  std::vector<double> gaps;
  for (size_t i = 0; i < order.size(); ++i) {
    double best = std::numeric_limits<double>::infinity();
    const auto meet = [&](size_t j) {
      best = std::min(best, (at[order[i]] - at[order[j]]).norm());
      return std::abs(at[order[i]].x() - at[order[j]].x()) < best;
    };
    for (size_t j = i + 1; j < order.size() && meet(j); ++j) {
    }
    for (size_t j = i; j-- > 0 && meet(j);) {
    }
    gaps.push_back(best);
  }
  std::sort(gaps.begin(), gaps.end());
  return gaps;
}

/// Returns the distances of lips and walls from the plane of a flat cut [m]; ascending.
template <class Of>
std::vector<double> distancesFromPlane(const Of& of, const std::vector<Vector3d>& at, const Vector3d& on_plane,
                                       const Vector3d& normal) {
  std::vector<double> out;
  for (size_t v = of.wound.ownVertices(); v < at.size(); ++v) out.push_back(std::abs(normal.dot(at[v] - on_plane)));
  std::sort(out.begin(), out.end());
  return out;
}

template <class Of>
double volume(const Of& of, const std::vector<Vector3d>& at) {
  double sum = 0;
  const std::vector<uint32_t> triangles = of.triangles();
  for (size_t t = 0; t < triangles.size(); t += 3) {
    sum += at[triangles[t]].dot(at[triangles[t + 1]].cross(at[triangles[t + 2]])) / 6;
  }
  return sum;
}

/// A square image of a body that only distinguishes fronts from backs of triangles, exact to rounding of doubles.
class BackCamera {
 public:
  static constexpr int kPixels = 128;

  BackCamera(const Vector3d& eye, const Vector3d& target, double half_width_m) : eye_(eye) {
    ahead_ = (target - eye).normalized();
    right_ = ahead_.unitOrthogonal();
    down_ = ahead_.cross(right_);
    tangent_ = half_width_m / (target - eye).norm();
  }

  /// @returns number of pixels at which the back of a triangle is nearest
  size_t backsSeen(const std::vector<uint32_t>& triangles, const std::vector<Vector3d>& at) {
    seen_.clear();
    for (const Vector3d& p : at) {
      const Vector3d from = p - eye_;
      seen_.push_back(Vector3d(from.dot(right_) / tangent_, from.dot(down_) / tangent_, from.dot(ahead_)));
    }
    depth_.assign(static_cast<size_t>(kPixels) * kPixels, std::numeric_limits<double>::infinity());
    back_.assign(depth_.size(), 0);
    for (size_t t = 0; t < triangles.size(); t += 3)
      draw(seen_[triangles[t]], seen_[triangles[t + 1]], seen_[triangles[t + 2]]);
    return static_cast<size_t>(std::count(back_.begin(), back_.end(), 1));
  }

 private:
  static constexpr double position(int pixel) { return (pixel + 0.5) / kPixels * 2 - 1; }  ///< centre of a pixel, -1..1
  static int pixelBefore(double share) {
    return static_cast<int>(std::floor(std::clamp((share + 1) / 2, -0.1, 1.1) * kPixels - 0.5));
  }
  /// Returns the range of pixels along one axis that a triangle covers; all of them if it extends behind the eye.
  static std::pair<int, int> reach(double a, double b, double c, bool ahead) {
    if (!ahead) return {0, kPixels - 1};
    return {std::max(0, pixelBefore(std::min({a, b, c}))), std::min(kPixels - 1, pixelBefore(std::max({a, b, c})) + 1)};
  }
  void draw(const Vector3d& a, const Vector3d& b, const Vector3d& c) {
    const bool ahead = std::min({a.z(), b.z(), c.z()}) > 1e-6;
    if (!ahead && std::max({a.z(), b.z(), c.z()}) < 0) return;
    for (const int axis : {0, 1}) {  // most of an organ is outside the image of its wound
      if (!ahead) break;
      if (a[axis] > a.z() && b[axis] > b.z() && c[axis] > c.z()) return;
      if (a[axis] < -a.z() && b[axis] < -b.z() && c[axis] < -c.z()) return;
    }
    const auto [left, right] = reach(a.x() / a.z(), b.x() / b.z(), c.x() / c.z(), ahead);
    const auto [top, bottom] = reach(a.y() / a.z(), b.y() / b.z(), c.y() / c.z(), ahead);
    if (left > right || top > bottom) return;
    const Vector3d bc = b.cross(c), ca = c.cross(a), ab = a.cross(b);
    const double whole = a.dot(bc);
    const double bc_x = bc.x(), ca_x = ca.x(), ab_x = ab.x();
    for (int y = top; y <= bottom; ++y) {  // u, v and w: by the ray of a pixel, with z = 1
      const double offset_y = position(y);
      const double u_y = offset_y * bc.y() + bc.z(), v_y = offset_y * ca.y() + ca.z(), w_y = offset_y * ab.y() + ab.z();
      for (int x = left; x <= right; ++x) {
        const double offset_x = position(x), u = offset_x * bc_x + u_y, v = offset_x * ca_x + v_y,
                     w = offset_x * ab_x + w_y;
        if (!((u >= 0 && v >= 0 && w >= 0) || (u <= 0 && v <= 0 && w <= 0))) continue;
        const double sum = u + v + w;
        if (sum == 0) continue;
        const double depth = whole / sum;
        const auto pixel = static_cast<size_t>(y * kPixels + x);
        if (depth <= 0 || depth >= depth_[pixel]) continue;
        depth_[pixel] = depth;
        back_[pixel] = sum > 0 ? 1 : 0;
      }
    }
  }

  Vector3d eye_, ahead_, right_, down_;
  double tangent_ = 1;
  std::vector<Vector3d> seen_;
  std::vector<double> depth_;
  std::vector<uint8_t> back_;
};

/// Returns the winding number of the shown mesh about a point.
inline double windingNumber(const std::vector<uint32_t>& triangles, const std::vector<Vector3d>& at,
                            const Vector3d& point) {
  double sum = 0;
  for (size_t t = 0; t < triangles.size(); t += 3) {
    const Vector3d a = at[triangles[t]] - point, b = at[triangles[t + 1]] - point, c = at[triangles[t + 2]] - point;
    const double na = a.norm(), nb = b.norm(), nc = c.norm();
    sum += 2 * std::atan2(a.dot(b.cross(c)), na * nb * nc + a.dot(b) * nc + b.dot(c) * na + c.dot(a) * nb);
  }
  return sum / (4 * M_PI);
}

/// Returns the share of pixels that show back faces in images of a wound from 200 positions outside the body: half of
/// them all around it, half in front of the wound, down to where one looks right into it.
template <class Of>
double backsSeen(const Of& of, const std::vector<Vector3d>& at, const Vector3d& wound_m, const Vector3d& outward,
                 double reach_m) {
  constexpr int kViews = 200;
  const std::vector<uint32_t> triangles = of.triangles();
  double size_m = 0;
  for (const Vector3d& p : at) size_m = std::max(size_m, (p - wound_m).norm());
  std::mt19937 random(3);
  std::normal_distribution<double> any;
  std::uniform_real_distribution<double> share(0, 1);
  size_t backs = 0;
  for (int view = 0; view < kViews;) {
    Vector3d offset = Vector3d(any(random), any(random), any(random)).normalized();
    double far_m = 1.2 * size_m;
    if (view % 2 == 0) {
      offset = (offset + 1.2 * outward).normalized();
      far_m = reach_m * (1 + 3 * share(random));
    }
    const Vector3d eye = wound_m + far_m * offset;
    if (std::abs(windingNumber(triangles, at, eye)) > 0.5) continue;  // within tissue
    backs += BackCamera(eye, wound_m, 1.2 * reach_m).backsSeen(triangles, at);
    ++view;
  }
  return static_cast<double>(backs) / (kViews * BackCamera::kPixels * BackCamera::kPixels);
}

/// Share of the 3.3 million pixels of an incision that is pulled open. The aim is none. A few remain: thin triangles
/// with corners on nodes of different cells that turn over (docs/surface.md). Organs had up to 3e-4 before.
constexpr double kBacks = 1e-4;
constexpr double kBacksAtRest = 1e-5;  // in addition, where an organ's own surface, uncut, shows some

inline double percentile99(const std::vector<double>& ascending) {
  return ascending.empty() ? 0 : ascending[std::min(ascending.size() - 1, ascending.size() * 99 / 100)];
}

}  // namespace viscera::testing
