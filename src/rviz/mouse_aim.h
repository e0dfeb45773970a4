// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <optional>

#include "rviz/sent_surface.h"
#include "viscera/math/types.h"

namespace viscera::rviz_plugin {

/// A place on the screen as a ray into the scene; lengths 1, at right angles, in the frame of the surface.
struct ScreenRay {
  Vector3d origin_m, direction;
  Vector3d right, up;  ///< of the camera
};

/// Where a tip is that a mouse leads: on the ray, so far before the skin or behind it.
class MouseAim {
 public:
  /// Skin that a tool pushes gives way, and a ray to it would go after it, deeper and deeper. So from the moment in
  /// which the tip reaches the skin, or a button is pressed, it is led along the skin as it was then.
  /// @param depth_m  behind the skin, below 0 before it   @param tilt_rad  of the shaft, from the ray to the lower
  /// right
  /// @returns pose of the stylus, its shaft along +z; nothing while no surface is known
  std::optional<Pose> at(const ScreenRay& ray, const SentSurface& live, double depth_m, double tilt_rad, bool pressed);
  void clear() { *this = MouseAim(); }

 private:
  std::shared_ptr<const SentTopology> topology_;  ///< of the skin along which it is led
  SurfaceVerticesConstPtr vertices_;
  std::optional<double> distance_m_;  ///< of the skin, where a ray has met it last
};

}  // namespace viscera::rviz_plugin
