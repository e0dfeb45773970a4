// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "rviz/surface_display.h"

#include <OgreRenderSystem.h>
#include <OgreRenderSystemCapabilities.h>
#include <OgreRenderWindow.h>
#include <OgreRoot.h>
#include <OgreSceneNode.h>
#include <ros/console.h>
#include <rviz/display_context.h>
#include <rviz/frame_manager.h>
#include <rviz/properties/bool_property.h>
#include <rviz/properties/color_property.h>
#include <rviz/properties/enum_property.h>
#include <rviz/properties/float_property.h>
#include <rviz/properties/ros_topic_property.h>
#include <rviz/render_panel.h>
#include <rviz/view_manager.h>
#include <QTimer>
#include <pluginlib/class_list_macros.hpp>

#include <cmath>
#include <optional>
#include <utility>

#include "rviz/surface_mesh.h"
#include "rviz/view_fit.h"
#include "rviz/window_sizes.h"

namespace viscera::rviz_plugin {
namespace {

enum ColorBy { kByBody, kBySent, kByStrain };
constexpr std::chrono::seconds kTellEvery{1};
constexpr double kGoldenTurn = 0.618034;  // of the circle of hues: neighbouring bodies in the list differ most

/// Converts a colour. @param color  sRGB, red in the low byte
Ogre::ColourValue sentColor(uint32_t color, float alpha) {
  constexpr float kMost = 255;
  const auto share = [color](unsigned shift) { return static_cast<float>(color >> shift & 0xffU) / kMost; };
  return Ogre::ColourValue(share(0), share(8), share(16), alpha);
}

Ogre::ColourValue ofBody(const QColor& color, size_t body, float alpha) {
  QColor turned = color;
  const double hue = std::max(color.hsvHueF(), 0.0) + kGoldenTurn * static_cast<double>(body);  // the hue of grey is -1
  turned.setHsvF(hue - std::floor(hue), color.hsvSaturationF(), color.valueF());
  return Ogre::ColourValue(static_cast<float>(turned.redF()), static_cast<float>(turned.greenF()),
                           static_cast<float>(turned.blueF()), alpha);
}

}  // namespace

SurfaceDisplay::SurfaceDisplay() {
  topic_ = new rviz::RosTopicProperty("Surface topic", "surface", "viscera/SurfaceVertices",
                                      "Vertices; triangles come from the topics that have _topology and "
                                      "_topology_change after this name.",
                                      this);
  color_ = new rviz::ColorProperty(
      "Color", QColor(184, 64, 56),
      "Color of the skin of the first body, if the simulator sends none or Color by is body.", this);
  wall_color_ = new rviz::ColorProperty("Wound color", QColor(120, 20, 24), "Color of the walls of its wounds.", this);
  by_body_ = new rviz::BoolProperty("Hues of bodies", true, "Gives each body its own hue.", this);
  color_by_ =
      new rviz::EnumProperty("Color by", "sent",
                             "sent: the colors of the scene, and of vertices if the simulator sends some, as for "
                             "burns; body: the colors below; strain: from blue (none) to yellow, as in the overlay "
                             "`strain`.",
                             this);
  for (const auto& [name, value] : {std::pair{"body", kByBody}, {"sent", kBySent}, {"strain", kByStrain}})
    color_by_->addOption(name, value);
  alpha_ = new rviz::FloatProperty("Alpha", 1, "0 is transparent, 1 opaque.", this);
  alpha_->setMin(0);
  alpha_->setMax(1);
  fits_view_ =
      new rviz::BoolProperty("Fit first view", false,
                             "Moves the view so that the first surface fits into it, and the first one of another "
                             "scene unless the view was moved since. Not saved in layouts.",
                             this);
  fits_view_->setShouldBeSaved(false);  // a layout that the user saves keeps its view
  for (rviz::Property* property : {static_cast<rviz::Property*>(topic_), static_cast<rviz::Property*>(color_by_)})
    connect(property, &rviz::Property::changed, this, [this] { reset(); });
  for (rviz::Property* property : {static_cast<rviz::Property*>(color_), static_cast<rviz::Property*>(wall_color_),
                                   static_cast<rviz::Property*>(by_body_), static_cast<rviz::Property*>(alpha_)})
    connect(property, &rviz::Property::changed, this, [this] {
      drawn_vertices_.reset();  // vertex colours depend on the opacity
      paint();
    });
}

SurfaceDisplay::~SurfaceDisplay() = default;

/// Warns of slow drawing that the user can change (docs/rviz.md, Performance).
void SurfaceDisplay::warnOfSamples() const {
  const std::string renderer = Ogre::Root::getSingleton().getRenderSystem()->getCapabilities()->getDeviceName();
  const Ogre::RenderWindow* const window = context_->getViewManager()->getRenderPanel()->getRenderWindow();
  if (renderer.find("llvmpipe") == std::string::npos || window->getFSAA() < 2) return;
  ROS_WARN("%s draws %u samples per pixel; start rviz with --disable-anti-aliasing to draw surfaces more often",
           renderer.c_str(), window->getFSAA());
}

void SurfaceDisplay::onInitialize() {
  renewWindowSizes();
  QTimer::singleShot(0, this, [] { renewWindowSizes(); });  // for displays after this one in a layout
  warnOfSamples();
  mesh_ = std::make_unique<SurfaceMesh>(scene_manager_, scene_node_);
  view_ = std::make_unique<ViewFit>(context_);
}

void SurfaceDisplay::onEnable() {
  subscribe();
}

void SurfaceDisplay::onDisable() {
  feed_.unsubscribe();
  reset();
}

void SurfaceDisplay::setTopic(const QString& topic, const QString&) {
  topic_->setString(topic);
}

void SurfaceDisplay::reset() {
  rviz::Display::reset();
  feed_.clear();
  placed_ = true;
  sent_at_ = {};
  senders_.clear();
  clear();
  if (isEnabled() && initialized()) subscribe();
}

void SurfaceDisplay::clear() {
  drawn_topology_.reset();
  drawn_vertices_.reset();
  drawn_ = 0;
  if (mesh_) mesh_->clear();
}

void SurfaceDisplay::subscribe() {
  feed_.unsubscribe();
  const std::string topic = topic_->getTopicStd();
  if (topic.empty()) return;
  try {
    feed_.subscribe(update_nh_, topic, color_by_->getOptionInt() == kByStrain);
  } catch (const ros::Exception& error) {  // not a valid name of a topic
    feed_.unsubscribe();
    setStatus(rviz::StatusProperty::Error, "Topic", error.what());
  }
}

void SurfaceDisplay::update(float, float) {
  renewWindowSizes();
  if (feed_.vertices() && feed_.renew()) {
    clear();
    context_->queueRender();
  }
  const received::SentSurface& sent = feed_.surface();
  if (sent.vertices() && sent.vertices() != drawn_vertices_) {
    const bool topology_is_new = sent.topology() != drawn_topology_;
    const std::optional<float> alpha =
        color_by_->getOptionInt() == kByBody ? std::nullopt : std::optional(alpha_->getFloat());
    const bool anew = mesh_->show(*sent.topology(), *sent.vertices(), topology_is_new, alpha);
    drawn_vertices_ = sent.vertices();
    drawn_topology_ = sent.topology();
    ++drawn_;
    if (topology_is_new || anew) paint();
    context_->queueRender();
  }
  if (drawn_vertices_) {
    const bool placed = place();
    scene_node_->setVisible(placed);
    if (placed && fits_view_->getBool()) fitView();
  }
  tellSenders();
  if (std::chrono::steady_clock::now() >= sent_at_ + kTellEvery) tell();
}

/// Updates the status of the simulator when it changes.
void SurfaceDisplay::tellSenders() {
  using rviz::StatusProperty;
  const ros::Subscriber& vertices = feed_.vertices();
  const received::SenderWatch::Senders senders = feed_.senders();
  if (!vertices || !senders.known) return;
  const std::string topic = vertices.getTopic();
  std::string text = "no simulator sends " + topic;
  if (senders.alive.size() == 1) text = "sends " + topic;
  if (senders.alive.size() > 1) text = std::to_string(senders.alive.size()) + " nodes send " + topic;
  if (senders.alive.empty() && !senders.uris.empty())
    text = "the simulator that sent " + topic + " has died" + (drawn_vertices_ ? "; its last surface is shown" : "");
  if (std::exchange(senders_, text) == text) return;
  setStatusStd(senders.alive.size() == 1 ? StatusProperty::Ok : StatusProperty::Warn, "Simulator", text);
}

/// Places the surface. @returns whether the pose of its frame is known
bool SurfaceDisplay::place() {
  const std::string& frame = drawn_vertices_->header.frame_id;
  Ogre::Vector3 position;
  Ogre::Quaternion orientation;
  if (!context_->getFrameManager()->getTransform(frame, ros::Time(), position, orientation)) {
    if (std::exchange(placed_, false))
      setStatusStd(rviz::StatusProperty::Error, "Transform",
                   "tf does not connect '" + frame + "' to the fixed frame '" + fixed_frame_.toStdString() + "'");
    return false;
  }
  if (!std::exchange(placed_, true)) deleteStatus("Transform");
  scene_node_->setPosition(position);
  scene_node_->setOrientation(orientation);
  return true;
}

/// Fits the view once for each scene.
void SurfaceDisplay::fitView() {
  if (drawn_topology_->triangles.empty() || fitted_ == drawn_topology_->bodies) return;
  fitted_ = drawn_topology_->bodies;
  if (view_->fit(*scene_node_, mesh_->bounds())) context_->queueRender();
}

void SurfaceDisplay::paint() {
  if (!drawn_topology_) return;
  std::vector<Ogre::ColourValue> colors;
  for (const received::SentPart& part : drawn_topology_->parts) {
    const bool sent = part.color && color_by_->getOptionInt() != kByBody;
    colors.push_back(sent ? sentColor(*part.color, alpha_->getFloat())
                          : ofBody((part.walls ? wall_color_ : color_)->getColor(), by_body_->getBool() ? part.body : 0,
                                   alpha_->getFloat()));
  }
  mesh_->paint(colors);
  context_->queueRender();
}

/// Updates the status lines, once a second.
void SurfaceDisplay::tell() {
  using rviz::StatusProperty;
  const auto now = std::chrono::steady_clock::now();
  const double elapsed_s = std::chrono::duration<double>(now - sent_at_).count();
  const bool first = sent_at_ == std::chrono::steady_clock::time_point{};
  sent_at_ = now;
  const ros::Subscriber& vertices = feed_.vertices();
  if (!vertices) return;
  const QString topic = QString::fromStdString(vertices.getTopic());
  if (!feed_.surface().hasTopology())
    setStatus(StatusProperty::Warn, "Topology", "waiting for " + topic + "_topology");
  else if (!drawn_topology_)
    setStatus(StatusProperty::Warn, "Topology", "waiting for vertices that belong to it");
  else
    setStatus(StatusProperty::Ok, "Topology",
              QString("%1 triangles, %2 vertices, version %3")
                  .arg(drawn_topology_->triangles.size() / 3)
                  .arg(drawn_topology_->vertices)
                  .arg(drawn_topology_->version));
  if (drawn_vertices_ && !first) {
    const double rate_hz = static_cast<double>(drawn_) / elapsed_s;
    setStatus(StatusProperty::Ok, "Rate", QString("%1 Hz").arg(rate_hz, 0, 'f', 1));
    ROS_DEBUG_NAMED("surface", "%s: %.1f Hz, %zu triangles, version %u", vertices.getTopic().c_str(), rate_hz,
                    drawn_topology_->triangles.size() / 3, drawn_topology_->version);
  }
  if (feed_.wrong().empty())
    deleteStatus("Message");
  else
    setStatusStd(StatusProperty::Error, "Message", feed_.wrong());
  if (drawn_ > 0) feed_.forgive();  // later messages were valid
  drawn_ = 0;
}

}  // namespace viscera::rviz_plugin

PLUGINLIB_EXPORT_CLASS(viscera::rviz_plugin::SurfaceDisplay, rviz::Display)
