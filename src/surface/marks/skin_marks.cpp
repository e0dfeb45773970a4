// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "viscera/surface/skin_marks.h"

#include <algorithm>
#include <cmath>

#include "layout/mark_patterns.h"

namespace viscera {

namespace {

using Corners = std::array<uint32_t, 3>;

constexpr float kTorn = 2;  // a piece longer than at rest by this factor crosses a gap, where a triangle is split
constexpr float kDotShare = 0.9F;  // half a dot's width over its radius: a square for a disc

/// Returns the corners with the lowest one first, in the same sense.
Corners ordered(Corners corners) {
  std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()), corners.end());
  return corners;
}

/// Triangles of marks, and which of them a mesh shows whole.
class WholeTriangles {
 public:
  WholeTriangles(const std::vector<MarkStroke>& strokes, const VisibleTopology& topology)
      : all_(topology.revision == 1), near_(topology.vertices) {
    if (all_) return;
    for (const MarkStroke& stroke : strokes)
      for (const SkinPoint& point : stroke.points) near_[point.vertices[0]] = true;
    for (size_t t = 0; t + 2 < topology.triangles.size(); t += 3) {
      const Corners corners = {topology.triangles[t], topology.triangles[t + 1], topology.triangles[t + 2]};
      if (near_[corners[0]] || near_[corners[1]] || near_[corners[2]]) whole_.push_back(ordered(corners));
    }
    std::sort(whole_.begin(), whole_.end());
  }
  bool has(const Corners& corners) const {
    return all_ || std::binary_search(whole_.begin(), whole_.end(), ordered(corners));
  }

 private:
  bool all_;
  std::vector<bool> near_;
  std::vector<Corners> whole_;
};

struct Placed {
  Vector3f at_m, normal;
  bool split = false;
};

Placed positionOf(const SkinPoint& point, const VisibleMesh& mesh, const WholeTriangles& whole) {
  const Vector3f corners[] = {mesh.position_m(point.vertices[0]), mesh.position_m(point.vertices[1]),
                              mesh.position_m(point.vertices[2])};
  Placed out;
  out.split = !whole.has(point.vertices);
  Eigen::Index heaviest = 0;
  point.weights.maxCoeff(&heaviest);
  if (out.split) {
    out.at_m = corners[heaviest] + point.off_corner_m;
    out.normal = mesh.normal(point.vertices[static_cast<size_t>(heaviest)]);
    return out;
  }
  out.at_m = point.weights[0] * corners[0] + point.weights[1] * corners[1] + point.weights[2] * corners[2];
  out.normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]).stableNormalized();
  return out;
}

/// Draws the line of one stroke, pattern by pattern; lengths are in half widths as in shaders/draw/marks.glsl.
class Pen {
 public:
  Pen(const MarkStroke& stroke, MarkPattern pattern, std::vector<MarkPiece>& out)
      : mark_(stroke.mark),
        half_m_(stroke.half_width_m),
        pattern_(stroke.plain && pattern == MarkPattern::kCrossed ? MarkPattern::kSolid : pattern),
        out_(out) {}

  void dot(const Placed& at) {
    const Vector3f side_m = kDotShare * half_m_ * at.normal.unitOrthogonal();
    add(at.at_m - side_m, at.at_m + side_m, at.normal, 2 * kDotShare);
  }

  void line(const Placed& from, const Placed& to, float from_along_m, float to_along_m) {
    const float length = (to_along_m - from_along_m) / half_m_;
    const int parts = pattern_ == MarkPattern::kDashed || pattern_ == MarkPattern::kCrossed
                          ? std::max(1, static_cast<int>(std::ceil(length)))
                          : 1;
    for (int k = 0; k < parts; ++k) {
      const float first = static_cast<float>(k) / static_cast<float>(parts),
                  last = static_cast<float>(k + 1) / static_cast<float>(parts);
      const Vector3f offset_m = to.at_m - from.at_m;
      part(from.at_m + first * offset_m, from.at_m + last * offset_m, from.normal,
           from_along_m / half_m_ + first * length, from_along_m / half_m_ + last * length);
    }
  }

 private:
  void part(const Vector3f& from_m, const Vector3f& to_m, const Vector3f& normal, float from, float to) {
    const Vector3f ahead = (to_m - from_m).stableNormalized(), side = normal.cross(ahead);
    switch (pattern_) {
      case MarkPattern::kDashed:
        if (std::fmod((from + to) / 2, layout::kDashPeriod) < layout::kDash) add(from_m, to_m, normal, 2);
        return;
      case MarkPattern::kDouble:
        for (const float off : {-layout::kDoubleOff * half_m_, layout::kDoubleOff * half_m_})
          add(from_m + off * side, to_m + off * side, normal, 2 * layout::kDoubleHalf);
        return;
      case MarkPattern::kCrossed: {
        add(from_m, to_m, normal, 2 * layout::kThinHalf);
        const auto crossings = [](float at) { return std::floor((at - layout::kFirstCross) / layout::kCrossPeriod); };
        if (crossings(from) == crossings(to)) return;
        for (const float turn : {-1.0F, 1.0F}) {
          const Vector3f arm_m = layout::kCrossArm * half_m_ * (ahead + turn * side);
          add(to_m - arm_m, to_m + arm_m, normal, 2 * layout::kCrossHalf);
        }
        return;
      }
      case MarkPattern::kThin:
        return add(from_m, to_m, normal, 2 * layout::kThinHalf);
      case MarkPattern::kSolid:
        return add(from_m, to_m, normal, 2);
    }
  }

  /// @param width  in half widths of the mark
  void add(const Vector3f& from_m, const Vector3f& to_m, const Vector3f& normal, float width) {
    const Vector3f above_m = half_m_ * normal;
    out_.push_back({mark_, from_m + above_m, to_m + above_m, width * half_m_});
  }

  const uint32_t mark_;
  const float half_m_;
  const MarkPattern pattern_;
  std::vector<MarkPiece>& out_;
};

}  // namespace

std::vector<MarkPiece> markPieces(const VisibleMarks& marks, const VisibleMesh& mesh) {
  std::vector<MarkPiece> out;
  const WholeTriangles whole(*marks.strokes, *mesh.topology);
  for (const MarkStroke& stroke : *marks.strokes) {
    const MarkPattern pattern = marks.styles[stroke.mark].pattern;
    if ((stroke.patterns >> static_cast<uint32_t>(pattern) & 1U) == 0) continue;
    Pen pen(stroke, pattern, out);
    if (stroke.points.size() == 1) pen.dot(positionOf(stroke.points[0], mesh, whole));
    for (size_t i = 1; i < stroke.points.size(); ++i) {
      const SkinPoint &from = stroke.points[i - 1], &to = stroke.points[i];
      const Placed a = positionOf(from, mesh, whole), b = positionOf(to, mesh, whole);
      const bool torn = (a.split || b.split) && (b.at_m - a.at_m).norm() > kTorn * (to.rest_m - from.rest_m).norm();
      if (!torn) pen.line(a, b, from.along_m, to.along_m);
    }
  }
  return out;
}

}  // namespace viscera
