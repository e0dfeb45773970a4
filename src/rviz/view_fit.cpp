// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "rviz/view_fit.h"

#include <OgreAxisAlignedBox.h>
#include <OgreCamera.h>
#include <OgreSceneNode.h>
#include <rviz/display_context.h>
#include <rviz/properties/float_property.h>
#include <rviz/properties/vector_property.h>
#include <rviz/view_controller.h>
#include <rviz/view_manager.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace viscera::rviz_plugin {
namespace {

/// While it exists, rviz does not consider the layout changed by the user and does not ask about it on closing.
class Quiet {
 public:
  explicit Quiet(std::vector<rviz::Property*> properties) : properties_(std::move(properties)) { set(false); }
  ~Quiet() { set(true); }
  Quiet(const Quiet&) = delete;
  Quiet& operator=(const Quiet&) = delete;

 private:
  void set(bool saved) {
    for (rviz::Property* property : properties_) property->setShouldBeSaved(saved);
  }
  std::vector<rviz::Property*> properties_;
};

}  // namespace

float fittingDistance(float radius, float fov_y, float aspect) {
  const float narrow = 2 * std::atan(std::tan(fov_y / 2) * std::min(aspect, 1.0F));
  return radius / std::sin(narrow / 2);
}

bool ViewFit::fit(const Ogre::SceneNode& node, const Ogre::AxisAlignedBox& box) {
  rviz::ViewController* const view = context_->getViewManager()->getCurrent();
  if (!view || !view->getCamera() || !box.isFinite()) return false;
  auto* const focus = dynamic_cast<rviz::VectorProperty*>(view->subProp("Focal Point"));
  auto* const distance = dynamic_cast<rviz::FloatProperty*>(view->subProp("Distance"));
  const Ogre::Camera& camera = *view->getCamera();
  const Ogre::SceneNode* const target = camera.getParentSceneNode();
  if (!focus || !distance || !target) return false;
  if (moved_ && (focus->getVector() != focus_ || distance->getFloat() != distance_)) return false;
  const Ogre::Vector3 center = node._getFullTransform() * box.getCenter();
  const Ogre::Vector3 at = target->_getFullTransform().inverse() * center;
  const float away =
      fittingDistance(box.getHalfSize().length(), camera.getFOVy().valueRadians(), camera.getAspectRatio());
  const Quiet quiet({distance, focus, focus->subProp("X"), focus->subProp("Y"), focus->subProp("Z")});
  distance->setFloat(away);
  focus->setVector(at);
  moved_ = true;
  focus_ = focus->getVector();
  distance_ = distance->getFloat();
  return true;
}

}  // namespace viscera::rviz_plugin
