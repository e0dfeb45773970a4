// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "solver/reference/reference_obstacle.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "math/vec4.h"
namespace viscera {

namespace {

constexpr double kShortStep = 0.25;  // of a radius: shorter chords are not searched for (1/128 of it deep at most)
constexpr double kMiddle = 1e-6;     // of a radius: nearer to the axis there is no direction

Pose poseOf(const layout::vec4& position, const layout::vec4& q) {
  return {xyz(position), Quaterniond(q.w, q.x, q.y, q.z).normalized()};
}
Vector3d seenFrom(const Pose& pose, const Vector3d& x) {
  return pose.orientation.conjugate() * (x - pose.position_m);
}

/// Returns the smallest s >= 0 at which |a + s b| = radius, with a outside; nothing if there is none.
std::optional<double> firstAt(const Vector3d& a, const Vector3d& b, double radius) {
  const double bb = b.squaredNorm(), ab = a.dot(b), c = a.squaredNorm() - radius * radius;
  const double under = ab * ab - bb * c;
  if (bb == 0 || under <= 0 || ab >= 0) return std::nullopt;
  return (-ab - std::sqrt(under)) / bb;
}

}  // namespace

ReferenceObstacle::ReferenceObstacle(const layout::ObstacleMotion& motion, double dt_s)
    : shape_(motion.info.x),
      dt_s_(dt_s),
      radius_m_(motion.from.w),
      half_length_m_(motion.to.w),
      friction_(motion.velocity.w),
      restitution_(motion.spin.w),
      half_size_m_(xyz(motion.half_size)),
      velocity_(xyz(motion.velocity)),
      spin_(xyz(motion.spin)),
      from_(poseOf(motion.from, motion.from_orientation)),
      to_(poseOf(motion.to, motion.to_orientation)) {}

ReferenceObstacle ReferenceObstacle::enlarged(double below_m) const {
  ReferenceObstacle seen = *this;
  if (shape_ == layout::kShapePlane) {
    seen.from_.position_m += below_m * (from_.orientation * Vector3d::UnitZ());
    seen.to_.position_m += below_m * (to_.orientation * Vector3d::UnitZ());
  }
  seen.radius_m_ = std::max(0.0, radius_m_ + below_m);
  seen.half_size_m_ = (half_size_m_.array() + below_m).max(0.0);
  return seen;
}

std::optional<ObstacleMeeting> ReferenceObstacle::meet(const Vector3d& x_m, const Vector3d& x_next_m) const {
  const Vector3d from = seenFrom(from_, x_m), to = seenFrom(to_, x_next_m);
  const std::optional<Local> met = shape_ == layout::kShapePlane ? meetPlane(to)
                                   : shape_ == layout::kShapeBox ? meetBox(from, to)
                                                                 : meetRound(from, to);
  if (!met) return std::nullopt;
  return ObstacleMeeting{to_.orientation * met->normal, to_ * met->surface_m, (to - from).norm()};
}

std::optional<HalfSpace> ReferenceObstacle::outside(const Vector3d& x_m, const Vector3d& x_next_m) const {
  const std::optional<ObstacleMeeting> met = meet(x_m, x_next_m);
  if (!met) return std::nullopt;
  HalfSpace out{met->normal, met->normal.dot(met->surface_m - x_m), dt_s_ * velocityAt(x_m), friction_, restitution_};
  if (shape_ == layout::kShapePlane || shape_ == layout::kShapeBox) return out;
  const Vector3d p = seenFrom(to_, x_m), away = p - onAxis(p);
  if (away.norm() <= kMiddle * radius_m_) return out;
  out.normal = to_.orientation * away.normalized();
  out.least_m = radius_m_ - away.norm();
  return out;
}

/// Returns the contact with a plane; the tissue is on its +z side.
std::optional<ReferenceObstacle::Local> ReferenceObstacle::meetPlane(const Vector3d& to) const {
  if (to.z() >= 0) return std::nullopt;
  return Local{Vector3d::UnitZ(), {to.x(), to.y(), 0}};
}

/// Returns the contact with the face through which the path entered; for a node that was inside, the nearest face.
std::optional<ReferenceObstacle::Local> ReferenceObstacle::meetBox(const Vector3d& from, const Vector3d& to) const {
  const auto inside = [this](const Vector3d& p) { return (p.cwiseAbs().array() < half_size_m_.array()).all(); };
  int face = -1;
  if (inside(from)) {
    if (!inside(to)) return std::nullopt;
    (half_size_m_ - from.cwiseAbs()).minCoeff(&face);
  } else {
    double enters = 0, leaves = 1;  // shares of the path
    for (int k = 0; k < 3; ++k) {
      const double offset = to[k] - from[k];
      if (offset == 0 && std::abs(from[k]) >= half_size_m_[k]) return std::nullopt;
      if (offset == 0) continue;
      const double far_side = offset > 0 ? half_size_m_[k] : -half_size_m_[k];
      const double in = (-far_side - from[k]) / offset;
      if (in >= enters) {
        enters = in;
        face = k;
      }
      leaves = std::min(leaves, (far_side - from[k]) / offset);
    }
    if (face < 0 || enters >= leaves) return std::nullopt;
  }
  const double side = from[face] < 0 ? -1 : 1;
  Local out{side * Vector3d::Unit(face), to};
  out.surface_m[face] = side * half_size_m_[face];
  return out;
}

/// Returns the nearest point of the axis; of a sphere its centre.
Vector3d ReferenceObstacle::onAxis(const Vector3d& p) const {
  return {0, 0, std::clamp(p.z(), -half_length_m_, half_length_m_)};
}

/// Returns the share of the path at which it enters the sphere or capsule: into its cylinder between the ends, or into
/// one of the two spheres.
std::optional<double> ReferenceObstacle::entry(const Vector3d& from, const Vector3d& to) const {
  const Vector3d offset = to - from;
  double first = std::numeric_limits<double>::infinity();
  for (const double end : {-half_length_m_, half_length_m_}) {
    if (const auto at = firstAt(from - end * Vector3d::UnitZ(), offset, radius_m_)) first = std::min(first, *at);
  }
  const Vector3d across(1, 1, 0);
  const auto at = firstAt(from.cwiseProduct(across), offset.cwiseProduct(across), radius_m_);
  if (at && std::abs((from + *at * offset).z()) <= half_length_m_) first = std::min(first, *at);
  return first <= 1 ? std::optional(first) : std::nullopt;
}

/// Returns the contact along the radius; a node that passed through, or beyond the middle, returns to where it entered.
std::optional<ReferenceObstacle::Local> ReferenceObstacle::meetRound(const Vector3d& from, const Vector3d& to) const {
  const Vector3d away = to - onAxis(to), away_before = from - onAxis(from);
  const bool inside = away.norm() < radius_m_;
  if ((to - from).norm() > kShortStep * radius_m_ && away_before.norm() >= radius_m_) {
    if (const auto at = entry(from, to)) {
      const Vector3d surface = from + *at * (to - from), normal = (surface - onAxis(surface)).normalized();
      if (!inside || normal.dot(away) < 0) return Local{normal, surface};
    }
  }
  if (!inside) return std::nullopt;
  const double middle = kMiddle * radius_m_;
  const Vector3d normal = away.norm() > middle          ? away.normalized().eval()
                          : away_before.norm() > middle ? away_before.normalized().eval()
                                                        : Vector3d::UnitX().eval();
  return Local{normal, onAxis(to) + radius_m_ * normal};
}

namespace {

SweptSphere sphereOfShaft(const layout::ToolMotion& motion, double share) {
  const auto between = [&](const layout::vec4& near, const layout::vec4& far) -> Vector3d {
    return (1 - share) * xyz(near) + share * xyz(far);
  };
  return {between(motion.shaft_from, motion.shaft_far_from), between(motion.shaft_to, motion.shaft_far_to),
          motion.shaft_from.w};
}

}  // namespace

bool pushesByTip(const layout::ToolMotion& motion) {
  return (motion.info.y & (layout::kToolPushes | layout::kToolFeels)) == layout::kToolPushes;
}

bool pushesByShaft(const layout::ToolMotion& motion) {
  return (motion.info.y & (layout::kToolShaft | layout::kToolFeels)) == layout::kToolShaft;
}

SweptSphere tipOf(const layout::ToolMotion& motion) {
  return {xyz(motion.from), xyz(motion.to), motion.from.w};
}

SweptSphere shaftNear(const layout::ToolMotion& motion, const Vector3d& x_m) {
  const Vector3d near = xyz(motion.shaft_to), axis = xyz(motion.shaft_far_to) - near;
  return sphereOfShaft(motion, std::clamp((x_m - near).dot(axis) / axis.squaredNorm(), 0.0, 1.0));
}

std::optional<SweptSphere> shaftNearLine(const layout::ToolMotion& motion, const Vector3d& x_m, const Vector3d& along) {
  constexpr double kParallel2 = 1e-3;  // sin^2 of an angle, as in edges.glsl
  const Vector3d near = xyz(motion.shaft_to), axis = xyz(motion.shaft_far_to) - near;
  const Vector3d across = axis - axis.dot(along) / along.squaredNorm() * along;
  if (across.squaredNorm() <= kParallel2 * axis.squaredNorm()) return std::nullopt;
  return sphereOfShaft(motion, std::clamp((x_m - near).dot(across) / across.squaredNorm(), 0.0, 1.0));
}

std::optional<HalfSpace> outsideOfProbe(const SweptSphere& probe, const Vector3d& x_m, const Vector3d& x_next_m,
                                        double below_m) {
  const Vector3d from = probe.from_m, to = probe.to_m, travel = to - from;
  const double radius = std::max(0.0, probe.radius_m + below_m), length2 = travel.squaredNorm();
  // The final sphere for a node inside it, else the capsule that it has swept.
  const auto centreFor = [&](const Vector3d& x) {
    if (length2 == 0 || (x - to).norm() < kOnSphere * radius) return to;
    return Vector3d(from + std::clamp((x - from).dot(travel) / length2, 0.0, 1.0) * travel);
  };
  if ((x_next_m - centreFor(x_next_m)).norm() >= radius) return std::nullopt;
  const Vector3d away = x_m - centreFor(x_m);
  const bool has_direction = away.norm() > kMiddle * radius;
  const Vector3d normal = has_direction ? away.normalized().eval()
                          : length2 > 0 ? (-travel).normalized().eval()
                                        : Vector3d::UnitZ().eval();
  return HalfSpace{normal, radius - away.dot(normal), travel};
}

}  // namespace viscera
