// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "model/shape/organ/hollow_tube.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "math/number_text.h"
#include "model/shape/organ/phantom_shapes.h"
#include "model/shape/organ/strand.h"
#include "viscera/math/error.h"

namespace viscera {
namespace {

constexpr int kPieces = 8;             // straight pieces between two points of a path
constexpr double kSamePoint_m = 1e-6;  // points of a path that are nearer are the same
constexpr double kMost = std::numeric_limits<double>::infinity();
constexpr double kStraight = 1e-9;  // sine below which three points are on a line

/// Returns the radius of the circle through three points.
double bendRadius_m(const Vector3d& a, const Vector3d& b, const Vector3d& c) {
  const double twice_area = (b - a).cross(c - a).norm(), sides = (b - a).norm() * (c - b).norm() * (a - c).norm();
  return twice_area <= kStraight * (b - a).norm() * (c - a).norm() ? kMost : 0.5 * sides / twice_area;
}

[[noreturn]] void refuse(const std::string& text) {
  throw SceneError(text);
}

void requireBends(const HollowTube::Axis& axis, const std::string& key) {
  for (size_t i = 1; i + 1 < axis.points_m.size(); ++i) {
    const double bend_m = bendRadius_m(axis.points_m[i - 1], axis.points_m[i], axis.points_m[i + 1]);
    if (bend_m > axis.radius_m) continue;
    refuse(key + ".path bends with a radius of " + numberText(bend_m, 3) + " m near point " +
           std::to_string((i + kPieces / 2) / kPieces) + "; it must be more than the radius of the tube, " +
           numberText(axis.radius_m, 3) + " m. Move its points, or add points along the bend");
  }
}

}  // namespace

HollowTube::HollowTube(const TubeConfig& config, const std::string& body) {
  const std::string key = "body '" + body + "': tube";
  names_.push_back("tube");
  add(config.path, config.radius_m, config.wall_m, key);
  for (size_t i = 0; i < config.branches.size(); ++i) {
    const TubeBranch& branch = config.branches[i];
    const std::string at = key + ".branches[" + std::to_string(i) + "]";
    if (branch.name.empty() || std::find(names_.begin(), names_.end(), branch.name) != names_.end())
      refuse(at + ".name must be a name that no other branch has, and not 'tube'; found '" + branch.name + "'");
    names_.push_back(branch.name);
    add(branch.path, branch.radius_m > 0 ? branch.radius_m : config.radius_m,
        branch.wall_m > 0 ? branch.wall_m : config.wall_m, at);
  }
  join();
}

void HollowTube::add(const std::vector<MarkPoint>& path, double radius_m, double wall_m, const std::string& key) {
  if (path.size() < 2) refuse(key + ".path must have at least two points; found " + std::to_string(path.size()));
  if (wall_m >= radius_m) {
    refuse(key + ".wall_m must be less than its radius_m, " + numberText(radius_m, 4) + " m; found " +
           numberText(wall_m, 4) + " m");
  }
  std::vector<Strand::Knot> knots;
  for (const MarkPoint& point : path) {
    if (!knots.empty() && (knots.back().at - point.position_m).norm() < kSamePoint_m) {
      refuse(key + ".path[" + std::to_string(knots.size()) +
             "] repeats the point before it; points must be at least 1e-06 m apart");
    }
    knots.push_back({point.position_m, radius_m});
  }
  Axis axis;
  axis.radius_m = radius_m;
  axis.wall_m = wall_m;
  for (const Strand::Knot& knot : curveThrough(knots, kPieces)) {
    const double step_m = axis.points_m.empty() ? 0 : (knot.at - axis.points_m.back()).norm();
    axis.along_m.push_back(axis.along_m.empty() ? 0 : axis.along_m.back() + step_m);
    axis.points_m.push_back(knot.at);
  }
  requireBends(axis, key);
  axes_.push_back(std::move(axis));
  keys_.push_back(key);
}

bool HollowTube::isInLumenOf(uint32_t axis, const Vector3d& point_m) const {
  return placeOn(axis, point_m).distance_m < axes_[axis].lumenRadius_m();
}

/// Finds the ends that lie in other lumens.
void HollowTube::join() {
  for (uint32_t a = 1; a < axes_.size(); ++a) {
    Axis& axis = axes_[a];
    bool is_joined = false;
    for (uint32_t b = 0; b < axes_.size(); ++b) {
      if (b == a) continue;
      const bool at_start = b < a && isInLumenOf(b, axis.points_m.front());
      const bool at_end = isInLumenOf(b, axis.points_m.back());
      if ((at_start || at_end) && axis.radius_m > axes_[b].radius_m) {
        refuse(keys_[a] + ".radius_m must be at most that of '" + names_[b] + "', which it joins, " +
               numberText(axes_[b].radius_m, 4) + " m; found " + numberText(axis.radius_m, 4) + " m");
      }
      is_joined = is_joined || at_start;
      if (at_start) axis.opens_at_start = false;
      if (at_end) axis.opens_at_end = false;
    }
    if (!is_joined)
      refuse(keys_[a] + ".path[0] must lie in the lumen of the tube or of an earlier branch, so that lumens join");
  }
}

double HollowTube::thinnestWall_m() const {
  double out = kMost;
  for (const Axis& axis : axes_) out = std::min(out, axis.wall_m);
  return out;
}

double HollowTube::narrowestLumen_m() const {
  double out = kMost;
  for (const Axis& axis : axes_) out = std::min(out, axis.lumenRadius_m());
  return out;
}

Eigen::AlignedBox3d HollowTube::bounds() const {
  Eigen::AlignedBox3d out;
  for (const Axis& axis : axes_) {
    const auto count = axis.points_m.size();
    for (size_t i = 0; i < count; ++i) {
      // A flat end reaches as far as its disc does.
      Vector3d reach = Vector3d::Constant(axis.radius_m);
      const bool is_open = (i == 0 && axis.opens_at_start) || (i + 1 == count && axis.opens_at_end);
      if (is_open) {
        const Vector3d along =
            (i == 0 ? axis.points_m[1] - axis.points_m[0] : axis.points_m[i] - axis.points_m[i - 1]).normalized();
        reach = axis.radius_m * (1 - along.array().square()).max(0.0).sqrt();
      }
      out.extend(axis.points_m[i] - reach);
      out.extend(axis.points_m[i] + reach);
    }
  }
  return out;
}

HollowTube::Place HollowTube::placeOn(uint32_t index, const Vector3d& p) const {
  const Axis& axis = axes_[index];
  Place out;
  out.axis = index;
  out.distance_m = kMost;
  size_t piece = 1;
  Vector3d at = axis.points_m.front();
  for (size_t i = 1; i < axis.points_m.size(); ++i) {
    const Vector3d& from = axis.points_m[i - 1];
    const Vector3d line = axis.points_m[i] - from;
    const double t = std::clamp((p - from).dot(line) / line.squaredNorm(), 0.0, 1.0);
    const Vector3d nearest = from + t * line;
    const double distance_m = (p - nearest).norm();
    if (distance_m >= out.distance_m) continue;
    out.distance_m = distance_m;
    out.along_m = axis.along_m[i - 1] + t * line.norm();
    piece = i;
    at = nearest;
  }
  const double from_start_m = out.along_m, to_end_m = axis.length_m() - out.along_m;
  const bool is_start = axis.opens_at_start && (from_start_m <= to_end_m || !axis.opens_at_end);
  const Vector3d along = (axis.points_m[piece] - axis.points_m[piece - 1]).normalized();
  const double outward_m = (p - at).dot(is_start ? -along : along);
  out.beyond_m = (axis.opens_at_start || axis.opens_at_end) ? outward_m - (is_start ? from_start_m : to_end_m) : -kMost;
  const bool is_beyond = out.beyond_m > 0 && (is_start ? from_start_m : to_end_m) == 0;
  out.aside_m =
      is_beyond ? std::sqrt(std::max(0.0, out.distance_m * out.distance_m - outward_m * outward_m)) : out.distance_m;
  return out;
}

HollowTube::Place HollowTube::nearest(const Vector3d& point_m) const {
  Place out;
  double least_m = kMost;
  for (uint32_t a = 0; a < axes_.size(); ++a) {
    const Place place = placeOn(a, point_m);
    const double depth_m = place.distance_m - axes_[a].radius_m;
    if (depth_m >= least_m) continue;
    least_m = depth_m;
    out = place;
  }
  return out;
}

LabelledDistance HollowTube::tissue(const Vector3d& point_m) const {
  double outside_m = kMost, hollow_m = kMost, least_m = kMost;
  uint16_t part = 0;
  const double blend_m = axes_.size() > 1 ? thinnestWall_m() : 0;
  for (uint32_t a = 0; a < axes_.size(); ++a) {
    const Axis& axis = axes_[a];
    const Place at = placeOn(a, point_m);
    outside_m = smoothMin(outside_m, std::max(at.aside_m - axis.radius_m, at.beyond_m), blend_m);
    // The hollow goes on beyond an open end, so that nothing closes it.
    hollow_m = smoothMin(hollow_m, std::max(at.aside_m - axis.lumenRadius_m(), at.beyond_m - axis.radius_m), blend_m);
    if (at.distance_m - axis.radius_m >= least_m) continue;
    least_m = at.distance_m - axis.radius_m;
    part = static_cast<uint16_t>(a);
  }
  return {std::max(outside_m, -hollow_m), part};
}

double HollowTube::lumen(const Vector3d& point_m) const {
  double out = kMost;
  const double blend_m = axes_.size() > 1 ? thinnestWall_m() : 0;
  for (uint32_t a = 0; a < axes_.size(); ++a) {
    const Place at = placeOn(a, point_m);
    out = smoothMin(out, std::max(at.aside_m - axes_[a].lumenRadius_m(), at.beyond_m), blend_m);
  }
  return out;
}

bool HollowTube::isOnCap(const Vector3d& point_m) const {
  const Place at = nearest(point_m);
  return at.beyond_m > at.aside_m - axes_[at.axis].lumenRadius_m();
}

void moveOntoBorder(const std::function<double(const Vector3d&)>& distance_m, double reach_m, TriangleMesh& mesh) {
  constexpr int kSteps = 2;
  constexpr double kDifference = 0.02;  // of the reach
  constexpr double kSlope = 0.8;        // of a distance field's: edges, where it is less, stay
  const double d_m = kDifference * reach_m;
  for (Vector3f& position : mesh.positions_m) {
    const Vector3d start = position.cast<double>();
    Vector3d at = start;
    for (int step = 0; step < kSteps; ++step) {
      Vector3d slope;
      for (int c = 0; c < 3; ++c)
        slope[c] = (distance_m(at + d_m * Vector3d::Unit(c)) - distance_m(at - d_m * Vector3d::Unit(c))) / (2 * d_m);
      if (slope.norm() < kSlope) break;
      at -= distance_m(at) * slope / slope.squaredNorm();
    }
    if ((at - start).norm() <= reach_m) position = at.cast<float>();
  }
}

void compensateChords(const std::function<double(const Vector3d&)>& distance_m, TriangleMesh& mesh) {
  std::vector<double> cut_m3(mesh.positions_m.size(), 0), area_m2(mesh.positions_m.size(), 0);
  for (const auto& t : mesh.triangles) {
    std::array<Vector3d, 3> at;
    for (size_t c = 0; c < 3; ++c) at[c] = mesh.positions_m[t[c]].cast<double>();
    const double triangle_m2 = 0.5 * (at[1] - at[0]).cross(at[2] - at[0]).norm();
    double depth_m = 0;  // mean over the triangle, from the middles of its edges
    for (size_t c = 0; c < 3; ++c) depth_m -= distance_m(0.5 * (at[c] + at[(c + 1) % 3])) / 3;
    for (const uint32_t v : t) {
      cut_m3[v] += depth_m * triangle_m2;
      area_m2[v] += triangle_m2;
    }
  }
  const std::vector<Vector3f> normals = vertexNormals(mesh);
  for (size_t v = 0; v < normals.size(); ++v) {
    if (area_m2[v] > 0) mesh.positions_m[v] += static_cast<float>(cut_m3[v] / area_m2[v]) * normals[v];
  }
}

}  // namespace viscera
