// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "viscera/api.h"
#include "viscera/math/types.h"

namespace VISCERA_PUBLIC viscera {

enum class ObstacleShape { kPlane, kSphere, kCapsule, kBox };

/// Moving air. Speed at time t: velocity (1 + gust_ratio sin(2 pi t / gust_period)).
struct WindConfig {
  Vector3d velocity_m_per_s = Vector3d::Zero();
  double gust_ratio = 0;
  double gust_period_s = 1;
  double air_density_kg_per_m3 = 1.2;
  double drag_coefficient = 1;
};

struct EnvironmentConfig {
  Vector3d gravity_m_per_s2 = Vector3d(0, 0, -9.81);
  std::string world_frame = "world";
  std::string tissue_frame = "tissue";
  Vector3d tissue_position_m = Vector3d::Zero();
  Vector3d tissue_rotation_deg = Vector3d::Zero();
  /// Origin of the tissue frame in the frame of the scan that bodies come from [m].
  Vector3d scan_origin_m = Vector3d::Zero();
  WindConfig wind;
};

/// Contacts of bodies with themselves and with each other.
struct CollisionConfig {
  bool enabled = false;
  double distance_m = 0;  ///< distance of contact [m]; 0: from the springs
  double friction = 0.3;
  double restitution = 0;
};

/// Rigid object that nodes do not enter.
struct ObstacleConfig {
  std::string name = "obstacle";
  ObstacleShape shape = ObstacleShape::kPlane;
  Vector3d position_m = Vector3d::Zero();
  Vector3d rotation_deg = Vector3d::Zero();  ///< rotation about fixed x, then y, then z [deg]
  double radius_m = 0.02;
  double length_m = 0.1;                         ///< capsule: distance between the centres of its ends, along its z [m]
  Vector3d size_m = Vector3d::Constant(0.05);    ///< box: edges [m]
  Vector3d velocity_m_per_s = Vector3d::Zero();  ///< velocity of its position, from the start on [m/s]
  Vector3d rotation_deg_per_s = Vector3d::Zero();  ///< rotation vector per second, tissue frame [deg/s]
  std::string frame;  ///< tf frame that the obstacle is mounted on; empty: the tissue frame
  double friction = 0.3;
  double restitution = 0;
};

}  // namespace viscera
