// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "devices/device_profile.h"
#include "model/scene/scene_fields.h"

namespace viscera {

// The one list of a device profile's keys, for the visitors of field_ranges.h, which are to offer besides
// * quaternion(key, Quaterniond&, text)
// * given(bool&): is there such a map in the file?

constexpr Range kUnit{1e-6, 10};          // metres: from a micrometre to a yard and more
constexpr Range kDeviceReach{-10, 10};    // m
constexpr Range kMotionScale{0.01, 100};  // of the tool's way over the hand's
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
           "of geometry_msgs; `tf`: only a frame in tf; `crtk_arm`: the tool is an arm that others drive");
  v.text("topic", c.topic, "of the poses; `{name}` and `{stylus}` are put in. Of an arm: what its topics begin with");
  v.text("frame", c.frame, "of the poses, in place of the one that they name; needed where they name none");
  v.text("tf_frame", c.tf_frame, "type tf: the frame that follows the hand");
  v.text("tf_base", c.tf_base, "type tf: the frame of the tracker's base");
  v.number("unit_m", c.unit_m, kUnit, "m", "one unit of positions: 0.001 for millimetres");
  v.text("axes", c.axes, "which of the device's axes are ours: in `x -z y`, our y is the device's -z");
  v.text("turn_axes", c.turn_axes,
         "the same of orientations, where a driver turns these otherwise; default: as `axes`");
}

template <class V>
void visitFields(V& v, ButtonPort& c) {
  v.choice("type", c.type,
           {{"none", ButtonType::kNone}, {"joy", ButtonType::kJoy}, {"omni_button", ButtonType::kOmniButton}},
           "sensor_msgs/Joy, or omni_msgs/OmniButtonEvent (0 grey, 1 white)");
  v.text("topic", c.topic, "several buttons may share one");
  v.integer("index", c.index, kButtonIndex, "which of those in the message");
}

template <class V>
void visitFields(V& v, GripperPort& c) {
  v.choice(
      "presses", c.presses,
      {{"none", PressedButton::kNone},
       {"jaws", PressedButton::kJaws},
       {"button1", PressedButton::kButton1},
       {"button2", PressedButton::kButton2}},
      "the button whose place it takes besides; jaws: none, it opens the tool's jaws alone; none: it is not heard");
  v.text("topic", c.topic, "sensor_msgs/JointState; of an arm: its jaw/servo_jp, which needs no topic");
  v.integer("index", c.index, kButtonIndex, "which joint");
  v.number("closed_below", c.closed_below, kJoint, "rad or m", "pressed below this");
  v.number("open_above", c.open_above, kJoint, "rad or m", "released above this");
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
           "of geometry_msgs; omni_msgs/OmniFeedback; geomagic_control's");
  v.text("topic", c.topic, "to the driver, without anything between");
  v.text("absolute_topic", c.absolute_topic,
         "of a latched std_msgs/Bool `true`: CRTK's wrenches are in the frame of poses");
  v.text("message", c.message, "name of the message of type geomagic_feedback");
  v.number("scale", c.scale, {0, 100}, "1",
           "of forces and torques; the scene's limits are of what it takes, those below of what it gives");
  v.number("max_force_n", c.max_force_n, {0, 1000}, "N",
           "what the device is made for: never more, whatever the scene allows");
  v.number("max_torque_nm", c.max_torque_nm, {0, 100}, "N m", "the same");
}

template <class V>
void visitFields(V& v, ArmConfig& c) {
  v.vector("start_m", c.start_m, kDeviceReach, "m", "of the tip, in the base");
  v.vector("start_rotation_deg", c.start_rotation_deg, kAngle, "deg", "turns about x, then y, then z");
  v.number("speed_m_per_s", c.speed_m_per_s, {1e-4, 1}, "m/s", "of move_cp");
  v.number("turn_deg_per_s", c.turn_deg_per_s, {0.1, 1000}, "deg/s", "of move_cp");
  v.number("jaw_start_rad", c.jaw_start_rad, {-3.2, 3.2}, "rad", "angle of the jaws at the start");
}

template <class V>
void visitFields(V& v, ProfilePose& c) {
  v.given(c.given);
  v.vector("position_m", c.position_m, kDeviceReach, "m", "");
  v.quaternion("orientation_xyzw", c.orientation, "unit quaternion");
}

template <class V>
void visitFields(V& v, DeviceProfile& c) {
  v.text("about", c.about, "one line");
  v.text("name", c.name, "of the driver's topics or frames, `{name}` below; default: the stylus's");
  v.group("pose", c.pose, "where it is");
  v.group("tip", c.tip, "the tool's tip in the frame of the device's poses");
  v.group("base", c.base, "the device's base in the tissue frame, in place of tf's; null: tf's");
  v.number("scale", c.scale, kMotionScale, "1", "metres of the tool per metre of the hand");
  v.number("stale_after_s", c.stale_after_s, {0, 10}, "s", "in place of the stylus's; 0: as the scene says");
  v.number("delay_s", c.delay_s, {0, 0.05}, "s",
           "from a pose measured in it to the force that answers there; 0: the node's ~device_delay_s");
  v.group("button1", c.button1, "");
  v.group("button2", c.button2, "");
  v.group("clutch", c.clutch, "while it is pressed, the hand moves and the tool stays");
  v.group("gripper", c.gripper, "it opens and closes the tool's jaws");
  v.group("force", c.force, "what the hand is to feel");
  v.group("arm", c.arm, "of type crtk_arm");
}

}  // namespace viscera
