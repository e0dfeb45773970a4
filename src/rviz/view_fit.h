// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <OgreVector3.h>

namespace Ogre {
class AxisAlignedBox;
class SceneNode;
}  // namespace Ogre
namespace rviz {
class DisplayContext;
}

namespace viscera::rviz_plugin {

/// Fits the view to a surface and keeps the viewing direction; for views that rotate around a point, such as Orbit. A
/// view that the user has moved since is left alone.
class ViewFit {
 public:
  /// @param context  must outlive this object
  explicit ViewFit(rviz::DisplayContext* context) : context_(context) {}

  /// Fits the view.
  /// @param node  node of the surface, placed in the scene   @param box  bounding box in the node's frame
  /// @returns whether the view was moved
  bool fit(const Ogre::SceneNode& node, const Ogre::AxisAlignedBox& box);

 private:
  rviz::DisplayContext* const context_;
  bool moved_ = false;  ///< whether this object has moved the view, to:
  Ogre::Vector3 focus_ = Ogre::Vector3::ZERO;
  float distance_ = 0;
};

/// Returns the distance at which a sphere fits into the image of a camera.
/// @param radius  radius of the sphere   @param fov_y  of the camera [rad]   @param aspect  width divided by height
float fittingDistance(float radius, float fov_y, float aspect);

}  // namespace viscera::rviz_plugin
