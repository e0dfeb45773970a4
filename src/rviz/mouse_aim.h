// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <optional>

#include "nodes/received/sent_surface.h"
#include "viscera/math/types.h"

namespace viscera::rviz_plugin {

/// A point on the screen as a ray into the scene; unit vectors at right angles, in the frame of the surface.
struct ScreenRay {
  Vector3d origin_m, direction;
  Vector3d right, up;  ///< axes of the camera
};

/// Finds the tip of a stylus that the mouse moves: on the ray, at a given depth before or behind the surface.
class MouseAim {
 public:
  /// Returns the pose of the stylus. A tool pushes the surface away, and a ray to the live surface would follow it
  /// deeper and deeper. So the surface is frozen from the moment at which the tip reaches it or a button is pressed.
  /// @param depth_m  depth behind the surface, below 0 before it [m]
  /// @param tilt_rad  tilt of the shaft from the ray to the lower right
  /// @returns the pose, with the shaft along +z; nothing while no surface is known
  std::optional<Pose> at(const ScreenRay& ray, const received::SentSurface& live, double depth_m, double tilt_rad,
                         bool pressed);
  void clear() { *this = MouseAim(); }

 private:
  std::shared_ptr<const received::SentTopology> topology_;  ///< topology of the frozen surface
  SurfaceVerticesConstPtr vertices_;
  std::optional<double> distance_m_;  ///< distance along the ray to the last hit [m]
};

}  // namespace viscera::rviz_plugin
