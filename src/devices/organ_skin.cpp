// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "devices/organ_skin.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace viscera {
namespace {

constexpr double kBeside_m = 0.02;  ///< largest radius of a tool with its tip, and a margin for tremor [m]
// The view of config/viscera.rviz, in radians as in rviz.
constexpr double kViewYaw = 4.9, kViewPitch = 0.3;

Vector3d pointOf(const OrganSkin& skin, size_t vertex) {
  const float* p = &skin.points_m[3 * vertex];
  return {p[0], p[1], p[2]};
}

/// Returns the closest point of a triangle. Ericson, Real-Time Collision Detection, 5.1.5.
Vector3d nearestOf(const Vector3d& a, const Vector3d& b, const Vector3d& c, const Vector3d& p) {
  const Vector3d ab = b - a, ac = c - a, ap = p - a, bp = p - b, cp = p - c;
  const double d1 = ab.dot(ap), d2 = ac.dot(ap);
  if (d1 <= 0 && d2 <= 0) return a;
  const double d3 = ab.dot(bp), d4 = ac.dot(bp);
  if (d3 >= 0 && d4 <= d3) return b;
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return a + d1 / (d1 - d3) * ab;
  const double d5 = ab.dot(cp), d6 = ac.dot(cp);
  if (d6 >= 0 && d5 <= d6) return c;
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return a + d2 / (d2 - d6) * ac;
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 >= d3 && d5 >= d6) return b + (d4 - d3) / (d4 - d3 + d5 - d6) * (c - b);
  const double sum = va + vb + vc;
  return sum > 0 ? Vector3d(a + vb / sum * ab + vc / sum * ac) : a;
}

bool areTrianglesSound(const OrganSkin& skin) {
  const size_t vertices = skin.points_m.size() / 3;
  return !skin.triangles.empty() && skin.triangles.size() % 3 == 0 &&
         *std::max_element(skin.triangles.begin(), skin.triangles.end()) < vertices;
}

}  // namespace

Eigen::AlignedBox3d OrganSkin::box() const {
  Eigen::AlignedBox3d out;
  for (size_t v = 0; v < points_m.size() / 3; ++v) out.extend(pointOf(*this, v));
  return out;
}

std::optional<double> distanceToSkin(const OrganSkin& skin, const Vector3d& point_m) {
  if (!areTrianglesSound(skin)) return std::nullopt;
  constexpr double kTie = 1e-9;  // m: tolerance for triangles that share the nearest edge or corner
  double nearest = std::numeric_limits<double>::infinity(), sided = 0;
  double best_m = std::numeric_limits<double>::infinity();  ///< distance to the nearest corner, an upper bound
  for (size_t v = 0; v < skin.points_m.size() / 3; ++v)
    best_m = std::min(best_m, (pointOf(skin, v) - point_m).squaredNorm());
  best_m = std::sqrt(best_m);
  for (size_t t = 0; t + 2 < skin.triangles.size(); t += 3) {
    const Vector3d a = pointOf(skin, skin.triangles[t]), b = pointOf(skin, skin.triangles[t + 1]),
                   c = pointOf(skin, skin.triangles[t + 2]);
    // no point of a triangle is farther from its first corner than the longer edge from there
    const double reach = std::sqrt(std::max((b - a).squaredNorm(), (c - a).squaredNorm()));
    if ((a - point_m).squaredNorm() > (best_m + reach) * (best_m + reach)) continue;
    const Vector3d offset = point_m - nearestOf(a, b, c, point_m);
    const double distance = offset.norm();
    best_m = std::min(best_m, distance);
    if (distance > nearest + kTie) continue;
    // at an edge or a corner, the triangle with the largest distance of the point from its plane decides the side
    const double side = (b - a).cross(c - a).normalized().dot(offset);
    if (distance < nearest - kTie || std::abs(side) > std::abs(sided)) sided = side;
    nearest = std::min(nearest, distance);
  }
  return sided < 0 ? -nearest : nearest;
}

Pose startBefore(const OrganSkin& skin, const Vector3d& side) {
  const Vector3d out = side.normalized();
  const Eigen::AlignedBox3d box = skin.box();
  const Vector3d middle = box.isEmpty() ? Vector3d(Vector3d::Zero()) : Vector3d(box.center());
  double farthest_m = 0;
  for (size_t v = 0; v < skin.points_m.size() / 3; ++v) {
    const Vector3d from_middle = pointOf(skin, v) - middle;
    const double along_m = from_middle.dot(out);
    if ((from_middle - along_m * out).norm() < kBeside_m) farthest_m = std::max(farthest_m, along_m);
  }
  Eigen::Matrix3d axes;
  axes.col(2) = out;
  const Vector3d level = Vector3d::UnitZ().cross(out);
  axes.col(0) = level.norm() > 1e-6 ? Vector3d(level.normalized()) : Vector3d(Vector3d::UnitX());
  axes.col(1) = axes.col(2).cross(axes.col(0));
  return {middle + (farthest_m + kStartGap_m) * out, Quaterniond(axes)};
}

Vector3d sideOfTool(bool left) {
  const Vector3d to_viewer(std::cos(kViewYaw) * std::cos(kViewPitch), std::sin(kViewYaw) * std::cos(kViewPitch),
                           std::sin(kViewPitch));
  const Vector3d right = Vector3d::UnitZ().cross(to_viewer).normalized();
  const Vector3d up = to_viewer.cross(right);
  return (0.6 * to_viewer + (left ? -0.6 : 0.6) * right + 0.4 * up).normalized();
}

}  // namespace viscera
