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

/// Moves the view so that a surface fits into it, keeping the direction that it is seen from; for views that turn
/// around a point, as Orbit. What a person has moved since then is left alone.
class ViewFit {
 public:
  /// @param context  must outlive this
  explicit ViewFit(rviz::DisplayContext* context) : context_(context) {}

  /// @param node  of the surface, placed in the scene   @param box  of the surface, in the node's frame
  /// @returns whether the view was moved
  bool fit(const Ogre::SceneNode& node, const Ogre::AxisAlignedBox& box);

 private:
  rviz::DisplayContext* const context_;
  bool moved_ = false;  ///< by this, to:
  Ogre::Vector3 focus_ = Ogre::Vector3::ZERO;
  float distance_ = 0;
};

/// Returns how far a sphere is from a camera that it fits into the picture of.
/// @param radius  of the sphere   @param fov_y  of the camera [rad]   @param aspect  width by height
float fittingDistance(float radius, float fov_y, float aspect);

}  // namespace viscera::rviz_plugin
