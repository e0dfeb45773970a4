// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "surface/marks/mark_board.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "math/number_text.h"

namespace viscera {

namespace {

constexpr double kStepShare = 0.5;    // distance of points over the mean edge of the surface mesh
constexpr double kMostSteps = 4000;   // of a mark's line
constexpr double kFarthest_m = 0.05;  // along the normal to the surface that a point is moved to
constexpr int kLeastCorners = 24;     // of a circle
constexpr double kTurn = 6.28318530717958647692;
constexpr float kDotWidth = 1.3F;       // radius of a target's dot in widths of its lines
constexpr double kFilledShare = 0.6;    // radius of the dot that fills a target, over the target's
constexpr double kCrossShare = 0.8;     // half the length of a cross's arms, over the target's radius
constexpr double kTiltedCross = 0.125;  // turn of a cross from the axes

constexpr uint32_t bitOf(MarkPattern pattern) {
  return 1U << static_cast<uint32_t>(pattern);
}
constexpr uint32_t kFilled = bitOf(MarkPattern::kDouble), kCrossed = bitOf(MarkPattern::kCrossed),
                   kDotted = bitOf(MarkPattern::kSolid) | bitOf(MarkPattern::kDashed);

/// Makes the strokes of one mark.
class StrokeMaker {
 public:
  StrokeMaker(const RestSkin& skin, const MarkConfig& mark, MarkStroke first)
      : skin_(skin), mark_(mark), like_(std::move(first)) {}

  void line(std::vector<MarkStroke>& out) const {
    std::vector<Vector3d> corners;
    for (const MarkPoint& point : mark_.path) corners.push_back(point.position_m);
    out.push_back(through(corners, mark_.normal, kFarthest_m, like_));
  }

  void circle(std::vector<MarkStroke>& out) const {
    const auto [center_m, normal] = middle();
    out.push_back(around(center_m, normal, mark_.radius_m, like_));
  }

  void ring(std::vector<MarkStroke>& out) const {
    const Vector3d side = mark_.normal.normalized().unitOrthogonal(), other = mark_.normal.normalized().cross(side);
    for (auto& [from, to] : skin_.section(mark_.center_m, mark_.normal, mark_.radius_m)) {
      double at[2];
      for (size_t i = 0; i < 2; ++i) {
        const Vector3d offset = (i == 0 ? from : to).rest_m.cast<double>() - mark_.center_m;
        at[i] = std::atan2(offset.dot(other), offset.dot(side));
      }
      if (std::abs(at[1] - at[0]) > kTurn / 2) at[at[1] < at[0] ? 1 : 0] += kTurn;
      const double mean_m = ((from.rest_m + to.rest_m) / 2 - mark_.center_m.cast<float>()).norm();
      if (at[1] < at[0]) std::swap(from, to), std::swap(at[0], at[1]);
      from.along_m = static_cast<float>(at[0] * mean_m);
      to.along_m = static_cast<float>(at[1] * mean_m);
      MarkStroke& stroke = out.emplace_back(like_);
      stroke.points = {from, to};
    }
  }

  void target(std::vector<MarkStroke>& out) const {
    const auto [center_m, normal] = middle();
    MarkStroke plain = like_;
    plain.plain = true;
    out.push_back(around(center_m, normal, mark_.radius_m, plain));
    MarkStroke dot = plain;
    dot.points = {skin_.onto(center_m, normal, mark_.radius_m)};
    dot.patterns = kDotted;
    dot.half_width_m = kDotWidth * like_.half_width_m * 2;
    out.push_back(dot);
    dot.patterns = kFilled;
    dot.half_width_m = static_cast<float>(kFilledShare * mark_.radius_m);
    out.push_back(dot);
    plain.patterns = kCrossed;
    for (const double turn : {kTiltedCross, 0.25 + kTiltedCross}) {
      const Vector3d arm = positionOn(normal, turn, kCrossShare * mark_.radius_m);
      out.push_back(through({center_m - arm, center_m + arm}, normal, mark_.radius_m, plain));
    }
  }

 private:
  /// Returns the centre on the surface, and the normal of the mark's plane.
  std::pair<Vector3d, Vector3d> middle() const {
    const SkinPoint at = skin_.onto(mark_.center_m, mark_.normal, kFarthest_m);
    return {at.rest_m.cast<double>(), mark_.normal.isZero() ? skin_.normalAt(at) : mark_.normal};
  }

  static Vector3d positionOn(const Vector3d& normal, double turn, double radius_m) {
    const Vector3d up = normal.normalized(), side = up.unitOrthogonal();
    return radius_m * (std::cos(kTurn * turn) * side + std::sin(kTurn * turn) * up.cross(side));
  }

  MarkStroke around(const Vector3d& center_m, const Vector3d& normal, double radius_m, const MarkStroke& like) const {
    const double steps = std::min(kMostSteps, std::ceil(kTurn * radius_m / (kStepShare * skin_.edge_m())));
    const int count = std::max(kLeastCorners, static_cast<int>(steps));
    std::vector<Vector3d> corners;
    for (int i = 0; i <= count; ++i)
      corners.emplace_back(center_m + positionOn(normal, static_cast<double>(i) / count, radius_m));
    return through(corners, normal, radius_m, like);
  }

  /// Returns the line through points, moved onto the surface.
  MarkStroke through(const std::vector<Vector3d>& corners, const Vector3d& normal, double within_m,
                     const MarkStroke& like) const {
    MarkStroke out = like;
    double along_m = 0, length_m = 0;
    for (size_t i = 1; i < corners.size(); ++i) length_m += (corners[i] - corners[i - 1]).norm();
    const double step_m = std::max(kStepShare * skin_.edge_m(), length_m / kMostSteps);
    for (size_t i = 1; i < corners.size(); ++i) {
      const Vector3d offset_m = corners[i] - corners[i - 1];
      const int pieces = std::max(1, static_cast<int>(std::ceil(offset_m.norm() / step_m)));
      for (int k = i == 1 ? 0 : 1; k <= pieces; ++k) {
        const double share = static_cast<double>(k) / pieces;
        SkinPoint point = skin_.onto(corners[i - 1] + share * offset_m, normal, within_m);
        point.along_m = static_cast<float>(along_m + share * offset_m.norm());
        out.points.push_back(point);
      }
      along_m += offset_m.norm();
    }
    return out;
  }

  const RestSkin& skin_;
  const MarkConfig& mark_;
  const MarkStroke like_;
};

bool isAtTheSamePositions(const MarkConfig& a, const MarkConfig& b) {
  const auto same = [](const MarkPoint& p, const MarkPoint& q) { return p.position_m == q.position_m; };
  return a.body == b.body && a.kind == b.kind && a.center_m == b.center_m && a.normal == b.normal &&
         a.radius_m == b.radius_m && a.width_m == b.width_m &&
         std::equal(a.path.begin(), a.path.end(), b.path.begin(), b.path.end(), same);
}

void addStrokes(const RestSkins& skins, const MarkConfig& mark, uint32_t number, std::vector<MarkStroke>& out) {
  const bool is_line = mark.kind == MarkKind::kLine;
  if (is_line && mark.path.empty()) return;
  const size_t body = skins.bodyOf(mark.body, is_line ? mark.path[0].position_m : mark.center_m);
  MarkStroke like;
  like.mark = number;
  like.body = static_cast<uint32_t>(body);
  like.half_width_m = static_cast<float>(mark.width_m / 2);
  const StrokeMaker maker(skins[body], mark, like);
  switch (mark.kind) {
    case MarkKind::kLine:
      return maker.line(out);
    case MarkKind::kCircle:
      return maker.circle(out);
    case MarkKind::kRing:
      return maker.ring(out);
    case MarkKind::kTarget:
      return maker.target(out);
  }
}

}  // namespace

MarkBoard::MarkBoard(const Model& model) : model_(model) {}

std::shared_ptr<const VisibleMarks> MarkBoard::show(const std::vector<MarkConfig>& marks) {
  if (marks.empty() || model_.bodies.empty()) return nullptr;
  if (!strokes_ || !std::equal(marks.begin(), marks.end(), marks_.begin(), marks_.end(), isAtTheSamePositions)) {
    if (!skins_) skins_ = std::make_unique<RestSkins>(model_);
    std::vector<MarkStroke> strokes;
    for (size_t i = 0; i < marks.size(); ++i) addStrokes(*skins_, marks[i], static_cast<uint32_t>(i), strokes);
    strokes_ = std::make_shared<const std::vector<MarkStroke>>(std::move(strokes));
  }
  marks_ = marks;
  VisibleMarks out;
  out.strokes = strokes_;
  for (const MarkConfig& mark : marks) out.styles.push_back({mark.color.cast<float>(), mark.pattern});
  return std::make_shared<const VisibleMarks>(std::move(out));
}

std::string MarkBoard::faultOf(size_t number) const {
  const MarkConfig& mark = marks_[number];
  if (mark.kind == MarkKind::kRing) {
    const auto is_of = [&](const MarkStroke& stroke) { return stroke.mark == number; };
    if (std::any_of(strokes_->begin(), strokes_->end(), is_of)) return "";
    return "the plane of 'center_m' and 'normal' meets no surface within 'radius_m', " + numberText(mark.radius_m) +
           " m; it must be at least the distance of the surface from the centre";
  }
  std::vector<Vector3d> points;
  for (const MarkPoint& point : mark.path) points.push_back(point.position_m);
  if (mark.kind != MarkKind::kLine) points = {mark.center_m};
  for (const Vector3d& point_m : points) {
    const double away_m = (*skins_)[skins_->bodyOf(mark.body, points[0])].nearest(point_m).distance_m;
    if (away_m > kFarthest_m)
      return "a position of the mark is " + numberText(away_m, 3) + " m from the surface; at most " +
             numberText(kFarthest_m) + " m is accepted";
  }
  return "";
}

}  // namespace viscera
