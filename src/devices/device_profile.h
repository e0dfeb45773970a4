// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "viscera/math/error.h"
#include "viscera/math/types.h"
#include "viscera/model/scene/overrides.h"

namespace viscera {

struct StylusConfig;

/// How a device tells where it is.
enum class PoseType {
  kPoseStamped,       ///< geometry_msgs/PoseStamped
  kTransformStamped,  ///< geometry_msgs/TransformStamped, as CRTK before 2022, motion capture
  kPose,              ///< geometry_msgs/Pose: without stamp and frame
  kTf,                ///< only by a frame in tf
  kCrtkArm            ///< it tells nothing: it is told. The tool is a CRTK arm that others drive
};
struct PosePort {
  PoseType type = PoseType::kPoseStamped;
  std::string topic = "{stylus}/measured_cp";
  std::string frame;              ///< in place of the one that messages name
  std::string tf_frame, tf_base;  ///< of PoseType::kTf
  double unit_m = 1;              ///< metres per unit of length
  std::string axes = "x y z";     ///< of positions and orientations, as axesOf() reads them
  std::string turn_axes;          ///< of orientations, where they differ; empty: as `axes`
};

enum class ButtonType { kNone, kJoy, kOmniButton };
/// A button, a pedal or a clutch.
struct ButtonPort {
  ButtonType type = ButtonType::kNone;
  std::string topic;
  int index = 0;  ///< which of those in the message
};

enum class PressedButton { kNone, kJaws, kButton1, kButton2 };
/// A gripper or a pair of jaws: the tool's jaws open as far, and it may take a button's place, closed is pressed.
struct GripperPort {
  PressedButton presses = PressedButton::kNone;
  std::string topic = "{stylus}/gripper/measured_js";  ///< sensor_msgs/JointState
  int index = 0;
  double closed_below = 0;  ///< joint position [rad or m]
  double open_above = 0.1;
  double rad_per_unit = 1;  ///< opening of the tool's jaws per joint position
};

enum class ForceType { kNone, kWrenchStamped, kWrench, kOmniFeedback, kGeomagicFeedback };
struct ForcePort {
  ForceType type = ForceType::kWrenchStamped;
  std::string topic = "{stylus}/body/servo_cf";
  std::string absolute_topic;  ///< of a latched std_msgs/Bool, true: wrenches are not in the frame of the tip
  std::string message = "geomagic_control/DeviceFeedback";  ///< name of ForceType::kGeomagicFeedback's message
  double scale = 1;
  double max_force_n = 10, max_torque_nm = 0.5;  ///< of what the device is made for; the scene may allow less
};

/// A message of feedback is a force alone: its device has no torque, and no torque shrinks its force.
inline bool hasTorque(const ForcePort& port) {
  return port.type != ForceType::kOmniFeedback && port.type != ForceType::kGeomagicFeedback;
}

/// Of a tool that is driven as a CRTK arm.
struct ArmConfig {
  Vector3d start_m = Vector3d(0, -0.12, 0.05);
  Vector3d start_rotation_deg = Vector3d(90, 0, 0);
  double speed_m_per_s = 0.1, turn_deg_per_s = 90;  ///< of move_cp
  double jaw_start_rad = 0.5;
};

/// Rigid transform of a profile; what is not given is left to tf or is none.
struct ProfilePose {
  bool given = false;
  Vector3d position_m = Vector3d::Zero();
  Quaterniond orientation = Quaterniond::Identity();
  Pose pose() const { return {position_m, orientation}; }
};

/// What a kind of device or tracker sends and takes, so that it needs no glue: docs/devices.md.
struct DeviceProfile {
  std::string about;  ///< one line
  std::string name;   ///< of the driver's topics or frames, `{name}` in this file; empty: the stylus's
  PosePort pose;
  ProfilePose tip;   ///< of the tool in the frame of the device's poses (a pivot calibration finds it)
  ProfilePose base;  ///< of the device's base in the tissue frame (a registration finds it); not given: tf knows it
  double scale = 1;  ///< metres of the tool per metre of the hand
  double stale_after_s = 0;  ///< in place of the stylus's; 0: the stylus's
  double delay_s = 0;        ///< from a pose measured in it to the force that answers there; 0: as the node's parameter
  ButtonPort button1, button2, clutch;
  GripperPort gripper;
  ForcePort force;
  ArmConfig arm;

  std::string file;    ///< name of the profile
  std::string stylus;  ///< that it is for
};

/// A file of a device is wrong. Names the file, the line, the key and what is accepted.
struct DeviceError : Error {
  using Error::Error;
};

/// What a user asks for: a profile for one stylus.
struct DeviceChoice {
  std::string stylus;
  std::string profile = "crtk";  ///< name in config/devices, or a path
  std::string name;              ///< of the driver, in place of the profile's; empty: the profile's
  std::string registration;      ///< path of a file with `tip` or `base`, or empty
  Overrides overrides;           ///< keys of the profile, as in pose.tf_frame=station_2
};

/// Reads a profile, lays the registration and the overrides over it, and puts the names in.
/// @param path  of the profile   @param choice  the rest
/// @throws DeviceError, RegistrationError
DeviceProfile loadDevice(const std::string& path, const DeviceChoice& choice);
/// The same from a text. @param where  its name, for errors
DeviceProfile parseDevice(const std::string& yaml, const std::string& where, const DeviceChoice& choice);

/// The stylus's keys where its device has narrower ones: limits of force and torque, the age of poses.
StylusConfig withDevice(StylusConfig stylus, const DeviceProfile& device);

/// The rotation that turns a device's axes into ours: in "x -z y", our y is the device's -z.
/// @throws DeviceError  not three signed letters, an axis twice, or a mirror image; `key` is named
Eigen::Matrix3d axesOf(const std::string& axes, const std::string& key);

/// The table of a profile's keys, in Markdown.
std::string deviceKeysTable();

}  // namespace viscera
