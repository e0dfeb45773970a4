// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "rviz/mouse_tool.h"

#include <OgreCamera.h>
#include <OgreViewport.h>
#include <rviz/display_context.h>
#include <rviz/frame_manager.h>
#include <rviz/properties/float_property.h>
#include <rviz/properties/string_property.h>
#include <rviz/render_panel.h>
#include <rviz/view_controller.h>
#include <rviz/view_manager.h>
#include <rviz/viewport_mouse_event.h>
#include <rviz/visualization_manager.h>

#include <QApplication>
#include <QKeyEvent>
#include <cmath>
#include <pluginlib/class_list_macros.hpp>

#include "nodes/received/simulator_space.h"
#include "rviz/panel_style.h"
#include "rviz/stylus_sender.h"

namespace viscera::rviz_plugin {
namespace {

constexpr double kWheelNotch = 120;  // units of Qt's wheel per notch, an eighth of a degree each
constexpr double kFine = 0.1;        // factor of a step with Control
constexpr double kRadians = M_PI / 180;

Vector3d vector(const Ogre::Vector3& v) {
  return {v.x, v.y, v.z};
}

}  // namespace

MouseTool::MouseTool() {
  shortcut_key_ = 'h';
  rviz::Property* all = getPropertyContainer();
  space_ = new rviz::StringProperty("Namespace", "", "Namespace of the simulator; empty: that of rviz.", all);
  stylus_ = new rviz::StringProperty("Stylus", "left", "Stylus of the scene that the mouse moves.", all);
  depth_ = new rviz::FloatProperty(
      "Depth", -0.01F, "Depth of the tip behind the skin [m], negative in front of it. The wheel changes it.", all);
  step_ = new rviz::FloatProperty("Wheel step", 0.001F,
                                  "Change of the depth per wheel step [m]; a tenth of it with Control.", all);
  speed_ = new rviz::FloatProperty("Speed", 0.2F, "Largest speed of the tip [m/s], because a mouse jumps.", all);
  tilt_ = new rviz::FloatProperty("Tilt", 40, "Tilt of the shaft from the line of sight to the lower right [degrees].",
                                  all);
  step_->setMin(1e-6F);
  step_->setMax(0.1F);
  speed_->setMin(0.001F);
  speed_->setMax(10);
  tilt_->setMin(0);
  tilt_->setMax(80);
  connect(space_, &rviz::Property::changed, this, [this] {
    if (active_) follow();
  });
}

MouseTool::~MouseTool() {
  sender_.reset();
}

void MouseTool::onInitialize() {
  setName("Mouse stylus");
  setIcon(icon(Sign::kMouse));
  sender_ = std::make_unique<StylusSender>();
  context_->getViewManager()->getRenderPanel()->installEventFilter(this);  // rviz does not pass key releases to tools
}

void MouseTool::activate() {
  active_ = true;
  position_.reset();
  follow();
}

void MouseTool::deactivate() {
  active_ = false;
  keys_ = mouse_ = {};
  feed_.unsubscribe();
  feed_.clear();
  aim_.clear();
  sender_->rest();
  tell("");
}

/// Subscribes to the surface of the simulator.
void MouseTool::follow() {
  feed_.unsubscribe();
  feed_.clear();
  aim_.clear();
  topics_.clear();
  try {
    ros::NodeHandle node;
    node.setCallbackQueue(static_cast<rviz::VisualizationManager*>(context_)->getUpdateQueue());
    const std::string space = received::simulatorSpace(space_->getStdString());
    feed_.subscribe(node, space + "surface");
    topics_ = space;
  } catch (const ros::Exception&) {  // update() reports it
  }
}

std::array<bool, 2> MouseTool::pressed() const {
  return {keys_[0] || mouse_[0], keys_[1] || mouse_[1]};
}

void MouseTool::tell(const QString& text) {
  if (text != last_) setStatus(text);
  last_ = text;
}

void MouseTool::update(float, float) {
  if (!active_) return;
  // Releases may have gone to another window.
  if (!QApplication::activeWindow()) keys_ = {};
  if (QApplication::mouseButtons() == Qt::NoButton) mouse_ = {};
  const std::string stylus = stylus_->getStdString();
  std::string wrong;
  if (topics_.empty()) return tell("not a valid namespace: " + space_->getString());
  if (!ros::names::validate(stylus, wrong) || stylus.empty() || stylus[0] == '/')
    return tell("not a valid stylus name: " + stylus_->getString());
  if (feed_.renew()) aim_.clear();
  const std::optional<Pose> tip = aim();
  if (!tip) return sender_->rest();
  WantedStylus wanted;
  wanted.topics = topics_ + stylus + "/";
  wanted.frame = feed_.surface().vertices()->header.frame_id;
  wanted.tip = *tip;
  wanted.buttons = pressed();
  wanted.speed_m_per_s = speed_->getFloat();
  sender_->request(wanted);
  const double depth_mm = 1e3 * static_cast<double>(depth_->getFloat());
  tell(QString("%1: %2 mm %3 the skin%4%5. Wheel: depth (Control: fine). Left, 1: button 1. Right, 2: button 2. "
               "Shift: camera.")
           .arg(stylus_->getString())
           .arg(std::abs(depth_mm), 0, 'f', 1)
           .arg(depth_mm < 0 ? "before" : "behind", wanted.buttons[0] ? ", button 1" : "",
                wanted.buttons[1] ? ", button 2" : ""));
}

/// Returns the desired pose in the surface's frame; nothing while it is not known.
std::optional<Pose> MouseTool::aim() {
  const SurfaceVerticesConstPtr& vertices = feed_.surface().vertices();
  const received::SenderWatch::Senders senders = feed_.senders();
  if (senders.known && senders.alive.empty()) {
    tell(QString("no simulator sends ") + QString::fromStdString(topics_ + "surface"));
    return std::nullopt;
  }
  if (!vertices) {
    tell(QString("waiting for ") + QString::fromStdString(topics_ + "surface"));
    return std::nullopt;
  }
  Ogre::Vector3 position;
  Ogre::Quaternion orientation;
  if (!context_->getFrameManager()->getTransform(vertices->header.frame_id, ros::Time(), position, orientation)) {
    tell(QString("tf does not know ") + QString::fromStdString(vertices->header.frame_id));
    return std::nullopt;
  }
  if (!position_) {
    tell("point at the tissue");
    return std::nullopt;
  }
  const rviz::RenderPanel* panel = context_->getViewManager()->getRenderPanel();
  const Ogre::Camera* camera = panel->getCamera();
  const Ogre::Viewport* view = panel->getViewport();
  if (!camera || !view) return std::nullopt;
  const Ogre::Ray seen = camera->getCameraToViewportRay(
      static_cast<float>(position_->x) / static_cast<float>(std::max(view->getActualWidth(), 1)),
      static_cast<float>(position_->y) / static_cast<float>(std::max(view->getActualHeight(), 1)));
  const Ogre::Quaternion back = orientation.Inverse();
  const auto turned = [&back](const Ogre::Vector3& v) { return vector(back * v).normalized().eval(); };
  ScreenRay ray;
  ray.origin_m = vector(back * (seen.getOrigin() - position));
  ray.direction = turned(seen.getDirection());
  ray.right = turned(camera->getDerivedRight());
  ray.up = turned(camera->getDerivedUp());
  const std::array<bool, 2> down = pressed();
  return aim_.at(ray, feed_.surface(), depth_->getFloat(), kRadians * tilt_->getFloat(), down[0] || down[1]);
}

int MouseTool::processMouseEvent(rviz::ViewportMouseEvent& event) {
  if (event.panel != context_->getViewManager()->getRenderPanel()) return 0;
  position_ = ScreenPoint{event.x, event.y};
  if (event.shift()) {
    mouse_ = {};
    event.panel->getViewController()->handleMouseEvent(event);
    return Render;
  }
  if (event.type == QEvent::Wheel) {
    const double steps = (event.control() ? kFine : 1) * event.wheel_delta / kWheelNotch;
    depth_->setFloat(depth_->getFloat() + static_cast<float>(steps * static_cast<double>(step_->getFloat())));
  } else {
    mouse_ = {event.left(), event.right()};
  }
  return Render;
}

int MouseTool::processKeyEvent(QKeyEvent* event, rviz::RenderPanel*) {
  press(*event, true);
  return 0;
}

bool MouseTool::eventFilter(QObject* watched, QEvent* event) {
  if (active_ && event->type() == QEvent::KeyRelease) press(static_cast<QKeyEvent&>(*event), false);
  return rviz::Tool::eventFilter(watched, event);
}

/// Handles a key. @returns whether it is one of ours
bool MouseTool::press(const QKeyEvent& event, bool down) {
  const int key = event.key() - Qt::Key_1;
  if (key < 0 || key >= static_cast<int>(keys_.size())) return false;
  if (!event.isAutoRepeat()) keys_[static_cast<size_t>(key)] = down;
  return true;
}

}  // namespace viscera::rviz_plugin

PLUGINLIB_EXPORT_CLASS(viscera::rviz_plugin::MouseTool, rviz::Tool)
