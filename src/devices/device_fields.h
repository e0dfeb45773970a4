// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "devices/device_profile.h"
#include "model/scene/scene_fields.h"

namespace viscera {

// The one list of a device profile's keys, for the visitors of field_ranges.h. These also need
// * quaternion(key, Quaterniond&, text)
// * given(bool&): whether the file has this map

constexpr Range kUnit{1e-6, 10};          // metres per unit
constexpr Range kDeviceReach{-10, 10};    // m
constexpr Range kMotionScale{0.01, 100};  // motion of the tool over that of the device
constexpr Range kButtonIndex{0, 63};
constexpr Range kJoint{-100, 100};  // rad or m

template <class V>
void visitFields(V& v, PosePort& c) {
  v.choice("type", c.type,
           {{"pose_stamped", PoseType::kPoseStamped},
            {"transform_stamped", PoseType::kTransformStamped},
            {"pose", PoseType::kPose},
            {"tf", PoseType::kTf},
            {"crtk_arm", PoseType::kCrtkArm}},
           "message type of poses, of geometry_msgs; `tf`: only a frame in tf; `crtk_arm`: none, the tool is an arm "
           "that clients drive");
  v.text("topic", c.topic,
         "topic of the poses; `{name}` and `{stylus}` are replaced. For an arm: the prefix of its topics");
  v.text("frame", c.frame, "frame of the poses, instead of the one in their messages; needed if these have none");
  v.text("tf_frame", c.tf_frame, "type tf: the frame that moves with the device");
  v.text("tf_base", c.tf_base, "type tf: the frame of the tracker's base");
  v.number("unit_m", c.unit_m, kUnit, "m", "length of one unit of positions: 0.001 for millimetres");
  v.text("axes", c.axes, "axes of the device that become x, y and z here: in `x -z y`, our y is the device's -z");
  v.text("turn_axes", c.turn_axes,
         "the same axes for orientations, for a driver that turns these differently; default: as `axes`");
}

template <class V>
void visitFields(V& v, ButtonPort& c) {
  v.choice("type", c.type,
           {{"none", ButtonType::kNone}, {"joy", ButtonType::kJoy}, {"omni_button", ButtonType::kOmniButton}},
           "message type: sensor_msgs/Joy, or omni_msgs/OmniButtonEvent (0 grey, 1 white)");
  v.text("topic", c.topic, "topic of the button; several buttons may share one");
  v.integer("index", c.index, kButtonIndex, "index of the button in the message");
}

template <class V>
void visitFields(V& v, GripperPort& c) {
  v.choice("presses", c.presses,
           {{"none", PressedButton::kNone},
            {"jaws", PressedButton::kJaws},
            {"button1", PressedButton::kButton1},
            {"button2", PressedButton::kButton2}},
           "button that the gripper also presses; jaws: no button, it only opens the tool's jaws; none: it is ignored");
  v.text("topic", c.topic, "topic of a sensor_msgs/JointState; an arm takes its jaw/servo_jp and needs no topic");
  v.integer("index", c.index, kButtonIndex, "index of the joint in the message");
  v.number("closed_below", c.closed_below, kJoint, "rad or m", "joint position below which the button is pressed");
  v.number("open_above", c.open_above, kJoint, "rad or m", "joint position above which the button is released");
  v.number("rad_per_unit", c.rad_per_unit, {1e-3, 1e3}, "rad per rad or m",
           "opening of the tool's jaws over the joint's position");
}

template <class V>
void visitFields(V& v, ForcePort& c) {
  v.choice("type", c.type,
           {{"none", ForceType::kNone},
            {"wrench_stamped", ForceType::kWrenchStamped},
            {"wrench", ForceType::kWrench},
            {"omni_feedback", ForceType::kOmniFeedback},
            {"geomagic_feedback", ForceType::kGeomagicFeedback}},
           "message type of forces: of geometry_msgs, omni_msgs/OmniFeedback, or that of geomagic_control");
  v.text("topic", c.topic, "topic of forces, directly to the driver");
  v.text("absolute_topic", c.absolute_topic,
         "topic of a latched std_msgs/Bool `true`: CRTK's wrenches are in the frame of poses");
  v.text("message", c.message, "name of the message for type geomagic_feedback");
  v.number("scale", c.scale, {0, 100}, "1",
           "factor on forces and torques; the scene's limits apply before it, those below after it");
  v.number("max_force_n", c.max_force_n, {0, 1000}, "N",
           "largest force that the device is made for; it is never exceeded, whatever the scene allows");
  v.number("max_torque_nm", c.max_torque_nm, {0, 100}, "N m",
           "largest torque that the device is made for; it is never exceeded, whatever the scene allows");
}

template <class V>
void visitFields(V& v, ArmConfig& c) {
  v.choice(
      "joints", c.joints, {{"none", ArmJoints::kNone}, {"psm", ArmJoints::kPsm}, {"ecm", ArmJoints::kEcm}},
      "joints that the arm has: those of a da Vinci PSM or ECM, with the origin of the base as remote centre; none: "
      "a tip that goes anywhere");
  v.vector("start_m", c.start_m, kDeviceReach, "m", "initial position of the tip in the arm's base");
  v.vector("start_rotation_deg", c.start_rotation_deg, kAngle, "deg",
           "initial orientation of the tip: turns about x, then y, then z");
  v.number("speed_m_per_s", c.speed_m_per_s, {1e-4, 1}, "m/s", "largest speed of move_cp");
  v.number("turn_deg_per_s", c.turn_deg_per_s, {0.1, 1000}, "deg/s",
           "largest angular speed of move_cp and of jaw/move_jp");
  v.number("jaw_start_rad", c.jaw_start_rad, {-3.2, 3.2}, "rad", "initial angle of the jaws");
}

template <class V>
void visitFields(V& v, ProfilePose& c) {
  v.given(c.given);
  v.vector("position_m", c.position_m, kDeviceReach, "m", "position of the origin");
  v.quaternion("orientation_xyzw", c.orientation, "orientation, a unit quaternion");
}

template <class V>
void visitFields(V& v, DeviceProfile& c) {
  v.text("about", c.about, "description, one line");
  v.text("name", c.name, "name in the driver's topics or frames, `{name}` below; default: the stylus's");
  v.group("pose", c.pose, "poses that the device sends");
  v.group("tip", c.tip, "pose of the tool's tip in the frame of the device's poses");
  v.group("base", c.base, "pose of the device's base in the tissue frame, instead of that in tf; null: that in tf");
  v.number("scale", c.scale, kMotionScale, "1", "motion of the tool over that of the device, in metres per metre");
  v.number("stale_after_s", c.stale_after_s, {0, 10}, "s",
           "age above which a pose is ignored, instead of the stylus's; 0: that of the scene");
  v.number(
      "delay_s", c.delay_s, {0, 0.05}, "s",
      "delay from a pose measured in the device to the force that answers it there; 0: the node's ~device_delay_s");
  v.group("button1", c.button1, "button 1 of the stylus");
  v.group("button2", c.button2, "button 2 of the stylus");
  v.group("clutch", c.clutch, "clutch: while it is pressed, the device moves and the tool stays");
  v.group("gripper", c.gripper, "gripper that opens and closes the tool's jaws");
  v.group("force", c.force, "forces that the device receives");
  v.group("arm", c.arm, "settings of type crtk_arm");
}

}  // namespace viscera
