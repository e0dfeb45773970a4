// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "viscera/tools/obstacles.h"

#include "math/archive.h"
#include "viscera/layout/limits.h"

namespace viscera {

namespace {

constexpr double kRadian = 3.14159265358979323846 / 180;

/// Returns the rotation of a rotation vector [rad].
Quaterniond turned(const Vector3d& by) {
  const double angle = by.norm();
  return angle > 0 ? Quaterniond(Eigen::AngleAxisd(angle, by / angle)) : Quaterniond::Identity();
}

/// Returns the rotation vector [rad] of the shorter rotation from a to b.
Vector3d turnBetween(const Quaterniond& a, const Quaterniond& b) {
  const Eigen::AngleAxisd turn(b * a.conjugate());
  constexpr double kPi = 180 * kRadian;
  return (turn.angle() > kPi ? turn.angle() - 2 * kPi : turn.angle()) * turn.axis();
}

layout::vec4 packed(const Vector3d& v, double w) {
  return {static_cast<float>(v.x()), static_cast<float>(v.y()), static_cast<float>(v.z()), static_cast<float>(w)};
}

layout::vec4 packed(const Quaterniond& q) {
  return {static_cast<float>(q.x()), static_cast<float>(q.y()), static_cast<float>(q.z()), static_cast<float>(q.w())};
}

double radiusOf(const ObstacleConfig& config) {
  return config.shape == ObstacleShape::kSphere || config.shape == ObstacleShape::kCapsule ? config.radius_m : 0;
}

/// Returns the largest distance of a surface point from the centre of rotation [m].
double farthestSurface(const ObstacleConfig& config) {
  constexpr double kPlane_m = 1;  // default of solver.sleep_distance_m, the range of tissue
  switch (config.shape) {
    case ObstacleShape::kSphere:
      return config.radius_m;
    case ObstacleShape::kCapsule:
      return config.radius_m + 0.5 * config.length_m;
    case ObstacleShape::kBox:
      return 0.5 * config.size_m.norm();
    case ObstacleShape::kPlane:
      break;
  }
  return kPlane_m;
}

layout::ObstacleMotion motionOf(const ObstacleConfig& config, const RigidMotion& tick, int substep, int substeps,
                                double tick_s) {
  const double half_length = config.shape == ObstacleShape::kCapsule ? 0.5 * config.length_m : 0;
  const Pose from = interpolate(tick.from, tick.to, static_cast<double>(substep) / substeps);
  const Pose to = interpolate(tick.from, tick.to, static_cast<double>(substep + 1) / substeps);
  layout::ObstacleMotion out{};
  out.from = packed(from.position_m, radiusOf(config));
  out.to = packed(to.position_m, half_length);
  out.from_orientation = packed(from.orientation);
  out.to_orientation = packed(to.orientation);
  out.velocity = packed((tick.to.position_m - tick.from.position_m) / tick_s, config.friction);
  out.spin = packed(turnBetween(tick.from.orientation, tick.to.orientation) / tick_s, config.restitution);
  out.half_size = packed(0.5 * config.size_m, 0);
  out.info.x = static_cast<uint32_t>(config.shape);
  return out;
}

}  // namespace

static_assert(static_cast<uint32_t>(ObstacleShape::kPlane) == layout::kShapePlane);
static_assert(static_cast<uint32_t>(ObstacleShape::kSphere) == layout::kShapeSphere);
static_assert(static_cast<uint32_t>(ObstacleShape::kCapsule) == layout::kShapeCapsule);
static_assert(static_cast<uint32_t>(ObstacleShape::kBox) == layout::kShapeBox);

Obstacles::Obstacles(const std::vector<ObstacleConfig>& configs, double max_travel_m)
    : configs_(configs),
      max_travel_m_(max_travel_m),
      speed_limited_(configs.size()),
      frames_(configs.size()),
      frames_before_(configs.size()),
      motions_(configs.size()) {
  reset();
}

void Obstacles::setFrame(size_t obstacle, const Pose& frame) {
  if (obstacle >= frames_.size()) return;
  frames_[obstacle] = {frame.position_m, frame.orientation.normalized()};
}

/// Returns the pose of an obstacle at a time, for a pose of its frame.
Pose Obstacles::placed(size_t obstacle, double time_s, const Pose& frame) const {
  const ObstacleConfig& config = configs_[obstacle];
  Pose pose = frame * Pose{config.position_m, rotationFromDegrees(config.rotation_deg)};
  pose.position_m += time_s * config.velocity_m_per_s;
  pose.orientation = (turned(time_s * kRadian * config.rotation_deg_per_s) * pose.orientation).normalized();
  return pose;
}

/// Limits a motion to the distance that a surface may move in a tick.
RigidMotion Obstacles::limited(size_t obstacle, const RigidMotion& wanted) {
  const double turn = turnBetween(wanted.from.orientation, wanted.to.orientation).norm();
  const double travel_m =
      (wanted.to.position_m - wanted.from.position_m).norm() + turn * farthestSurface(configs_[obstacle]);
  if (travel_m <= max_travel_m_) return wanted;
  speed_limited_[obstacle] = true;
  return {wanted.from, interpolate(wanted.from, wanted.to, max_travel_m_ / travel_m)};
}

void Obstacles::advance(double time_s, double tick_s) {
  for (size_t i = 0; i < configs_.size(); ++i) {
    const Pose now = frames_[i].value_or(Pose{});
    speed_limited_[i] = false;
    if (frames_before_[i]) {
      motions_[i] = limited(i, {motions_[i].to, placed(i, time_s + tick_s, now)});
    } else {
      motions_[i] = {placed(i, time_s, now), placed(i, time_s + tick_s, now)};
    }
    frames_before_[i] = frames_[i];
  }
}

void Obstacles::reset() {
  frames_before_ = frames_;
  speed_limited_.assign(configs_.size(), false);
  for (size_t i = 0; i < configs_.size(); ++i) {
    const Pose start = placed(i, 0, frames_[i].value_or(Pose{}));
    motions_[i] = {start, start};
  }
}

void Obstacles::persist(Archive& archive) {
  archive.values(motions_);
  for (size_t i = 0; i < configs_.size(); ++i) {
    archive.value(frames_[i]);
    archive.value(frames_before_[i]);
    bool speed_limited = speed_limited_[i];
    archive.value(speed_limited);
    speed_limited_[i] = speed_limited;
  }
}

void interpolateObstacles(const std::vector<ObstacleConfig>& configs, const ObstacleMotions& motions, int substeps,
                          double tick_s, std::vector<layout::ObstacleMotion>& out) {
  out.assign(static_cast<size_t>(substeps) * layout::kMaxObstacles, layout::ObstacleMotion{});
  for (int s = 0; s < substeps; ++s) {
    for (size_t i = 0; i < configs.size(); ++i) {
      out[static_cast<size_t>(s) * layout::kMaxObstacles + i] = motionOf(configs[i], motions[i], s, substeps, tick_s);
    }
  }
}

}  // namespace viscera
