// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "nodes/views/markers/marker_style.h"

#include <cctype>
#include <cmath>
#include <cstdio>

#include "math/decompositions.h"
#include "math/number_text.h"
#include "nodes/ros/conversions.h"

namespace viscera::nodes {
namespace {

using visualization_msgs::InteractiveMarker;
using visualization_msgs::InteractiveMarkerControl;
using visualization_msgs::Marker;

// Positions are in sizes of the marker, along the shaft from the tip: beyond the arrow of rviz, which ends at 1.
constexpr double kGrip = 0.6, kHandle = 0.32, kHead = 0.3;  ///< diameters
constexpr double kHandleAt[] = {0, 1.2, 1.55}, kForwardAt = 1.9, kBackAt = 2.3;
constexpr double kLetter = 0.2, kLetterBeside = 0.35;
const std::string kPress = "press button ";

struct Color {
  float r, g, b, a;
};
constexpr Color kGripColor{1, 0.8F, 0.2F, 0.3F}, kStepColor{0.8F, 0.8F, 0.8F, 0.9F}, kTextColor{1, 1, 1, 0.9F};
constexpr Color kPressColors[] = {kGripColor, {0, 0.7F, 0.51F, 0.8F}, {0.9F, 0.6F, 0, 0.8F}};

Marker part(int type, const Color& color, const Vector3d& at, const Vector3d& scale) {
  Marker marker;
  marker.type = type;
  marker.pose = toMessage(Pose{at, Quaterniond::Identity()});
  marker.scale = toVector(scale);
  marker.color.r = color.r;
  marker.color.g = color.g;
  marker.color.b = color.b;
  marker.color.a = color.a;
  return marker;
}

Marker ball(const Color& color, double along_m, double width_m) {
  return part(Marker::SPHERE, color, {0, 0, along_m}, Vector3d::Constant(width_m));
}

Marker label(const std::string& text, double along_m, double size_m) {
  Marker marker =
      part(Marker::TEXT_VIEW_FACING, kTextColor, {0, kLetterBeside * size_m, along_m}, {0, 0, kLetter * size_m});
  marker.text = text;
  return marker;
}

/// Returns an arrow head on the shaft; rviz draws the arrow from one point to the other.
Marker head(double from_m, double to_m, double width_m) {
  Marker marker = part(Marker::ARROW, kStepColor, Vector3d::Zero(), {0.1 * width_m, width_m, std::abs(to_m - from_m)});
  marker.points.resize(2);
  marker.points[0].z = from_m;
  marker.points[1].z = to_m;
  return marker;
}

/// Returns a control along (and about) the axis into which a quaternion rotates x.
InteractiveMarkerControl control(uint8_t mode, const std::string& name, const Vector3d& axis) {
  InteractiveMarkerControl out;
  out.name = name;
  out.interaction_mode = mode;
  const Quaterniond turn = rotationBetween(Vector3d::UnitX(), axis);
  out.orientation.x = turn.x();
  out.orientation.y = turn.y();
  out.orientation.z = turn.z();
  out.orientation.w = turn.w();
  return out;
}

InteractiveMarkerControl gripOf(const MarkerStyle& style, size_t button) {
  // Moves across the line of sight. Controls that also move along it use the mouse wheel, and rviz repeats its clicks
  // in every frame: 2 to 20 cm each.
  InteractiveMarkerControl out = control(InteractiveMarkerControl::MOVE_PLANE,
                                         button == 0 ? "grip" : kPress + std::to_string(button), Vector3d::UnitX());
  out.orientation_mode = InteractiveMarkerControl::VIEW_FACING;
  out.independent_marker_orientation = true;
  out.always_visible = true;
  out.markers.push_back(
      ball(kPressColors[button], kHandleAt[button] * style.size_m, (button == 0 ? kGrip : kHandle) * style.size_m));
  if (button > 0) {
    out.markers.push_back(label(style.nameOf(button), kHandleAt[button] * style.size_m, style.size_m));
    out.description = "drag: moves the stylus and holds " + style.nameOf(button) + " until the mouse is released";
  }
  return out;
}

InteractiveMarkerControl stepOf(const MarkerStyle& style, bool forward) {
  InteractiveMarkerControl out =
      control(InteractiveMarkerControl::BUTTON, forward ? kForward : kBack, Vector3d::UnitX());
  out.always_visible = true;
  const double at = (forward ? kForwardAt : kBackAt) * style.size_m, half = kHead / 2 * style.size_m;
  out.markers.push_back(head(forward ? at + half : at - half, forward ? at - half : at + half, kHead * style.size_m));
  if (!forward) out.markers.push_back(label(lengthText(style.step_m), at + 2 * half, style.size_m));
  out.description = (forward ? "click: forward by " : "click: back by ") + lengthText(style.step_m);
  return out;
}

}  // namespace

std::string MarkerStyle::nameOf(size_t button) const {
  return modes[button].empty() ? "button " + std::to_string(button) : modes[button];
}

std::string MarkerStyle::menuNameOf(size_t button) const {
  std::string name = nameOf(button);
  name[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(name[0])));
  return modes[button].empty() ? name : name + " (button " + std::to_string(button) + ")";
}

int pressOf(const std::string& control) {
  for (int button : {1, 2})
    if (control == kPress + std::to_string(button)) return button;
  return 0;
}

std::string lengthText(double length_m) {
  return numberText(1e3 * length_m, 3) + " mm";
}

InteractiveMarker markerOf(const MarkerStyle& style, const Pose& pose) {
  InteractiveMarker marker;
  marker.header.frame_id = style.frame;
  marker.name = "stylus";
  marker.description = style.stylus;
  marker.scale = static_cast<float>(style.size_m);
  marker.pose = toMessage(pose);
  for (size_t button = 0; button < 3; ++button)
    if (button == 0 || style.shows(button)) marker.controls.push_back(gripOf(style, button));
  const Vector3d axes[] = {Vector3d::UnitX(), Vector3d::UnitY(), Vector3d::UnitZ()};
  for (size_t i = 0; i < 3; ++i) {
    const std::string name(1, static_cast<char>('x' + i));
    marker.controls.push_back(control(InteractiveMarkerControl::MOVE_AXIS, "move " + name, axes[i]));
    marker.controls.push_back(control(InteractiveMarkerControl::ROTATE_AXIS, "turn " + name, axes[i]));
  }
  marker.controls.push_back(stepOf(style, true));
  marker.controls.push_back(stepOf(style, false));
  return marker;
}

}  // namespace viscera::nodes
