// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "viscera/math/error.h"
#include "viscera/math/types.h"
#include "viscera/model/scene/overrides.h"

namespace viscera {

struct StylusConfig;

/// How a device reports its pose.
enum class PoseType {
  kPoseStamped,       ///< geometry_msgs/PoseStamped
  kTransformStamped,  ///< geometry_msgs/TransformStamped, as in CRTK before 2022 and motion capture
  kPose,              ///< geometry_msgs/Pose, which has neither stamp nor frame
  kTf,                ///< a frame in tf only
  kCrtkArm            ///< none: the tool is a CRTK arm that clients command
};
struct PosePort {
  PoseType type = PoseType::kPoseStamped;
  std::string topic = "{stylus}/measured_cp";
  std::string frame;              ///< frame that replaces the one in messages
  std::string tf_frame, tf_base;  ///< frames for PoseType::kTf
  double unit_m = 1;              ///< metres per unit of length [m]
  std::string axes = "x y z";     ///< axes of positions and orientations, in the format of axesOf()
  std::string turn_axes;          ///< axes of orientations if they differ; empty: as `axes`
};

enum class ButtonType { kNone, kJoy, kOmniButton };
/// A button, a pedal or a clutch.
struct ButtonPort {
  ButtonType type = ButtonType::kNone;
  std::string topic;
  int index = 0;  ///< index in the message
};

enum class PressedButton { kNone, kJaws, kButton1, kButton2 };
/// A gripper or a pair of jaws. It opens the tool's jaws, and may act as a button that is pressed when closed.
struct GripperPort {
  PressedButton presses = PressedButton::kNone;
  std::string topic = "{stylus}/gripper/measured_js";  ///< sensor_msgs/JointState
  int index = 0;
  double closed_below = 0;  ///< joint position below which it is closed [rad or m]
  double open_above = 0.1;
  double rad_per_unit = 1;  ///< opening of the tool's jaws per joint position [rad/rad or rad/m]
};

enum class ForceType { kNone, kWrenchStamped, kWrench, kOmniFeedback, kGeomagicFeedback };
struct ForcePort {
  ForceType type = ForceType::kWrenchStamped;
  std::string topic = "{stylus}/body/servo_cf";
  std::string absolute_topic;  ///< topic of a latched std_msgs/Bool, true: wrenches are not in the frame of the tip
  std::string message = "geomagic_control/DeviceFeedback";  ///< name of the message of ForceType::kGeomagicFeedback
  double scale = 1;
  double max_force_n = 10, max_torque_nm = 0.5;  ///< limits of the device; the scene may have lower ones
};

/// Returns whether the message has a torque. Feedback messages have a force only, and a torque does not scale it down.
inline bool hasTorque(const ForcePort& port) {
  return port.type != ForceType::kOmniFeedback && port.type != ForceType::kGeomagicFeedback;
}

/// Joints of a tool that is driven as a CRTK arm: DaVinciArm.
enum class ArmJoints { kNone, kPsm, kEcm };
/// Parameters of a tool that is driven as a CRTK arm.
struct ArmConfig {
  ArmJoints joints = ArmJoints::kNone;
  Vector3d start_m = Vector3d(0, -0.12, 0.05);
  Vector3d start_rotation_deg = Vector3d(90, 0, 0);
  double speed_m_per_s = 0.1, turn_deg_per_s = 90;  ///< speeds of move_cp
  double jaw_start_rad = 0.5;
};

/// Rigid transform of a profile. If it is not given, tf provides it or there is none.
struct ProfilePose {
  bool given = false;
  Vector3d position_m = Vector3d::Zero();
  Quaterniond orientation = Quaterniond::Identity();
  Pose pose() const { return {position_m, orientation}; }
};

/// Interface of a kind of device or tracker, so that it needs no adapter node: docs/devices.md.
struct DeviceProfile {
  std::string about;  ///< description, one line
  std::string name;   ///< name in the driver's topics or frames, `{name}` in this file; empty: the stylus's
  PosePort pose;
  ProfilePose tip;           ///< tool tip in the frame of the device's poses (from a pivot calibration)
  ProfilePose base;          ///< device's base in the tissue frame (from a registration); not given: from tf
  double scale = 1;          ///< metres of the tool per metre of the device
  double stale_after_s = 0;  ///< replaces the stylus's key [s]; 0: the stylus's
  double delay_s = 0;        ///< delay from a measured pose to the force that answers it [s]; 0: the node's parameter
  ButtonPort button1, button2, clutch;
  GripperPort gripper;
  ForcePort force;
  ArmConfig arm;

  std::string file;    ///< name of the profile
  std::string stylus;  ///< stylus that uses the device
};

/// Error in a file of a device. Names the file, the line, the key and the accepted values.
struct DeviceError : Error {
  using Error::Error;
};

/// A user's choice of a profile for one stylus.
struct DeviceChoice {
  std::string stylus;
  std::string profile = "crtk";  ///< name in config/devices, or a path
  std::string name;              ///< name of the driver, replaces the profile's; empty: the profile's
  std::string registration;      ///< path of a file with `tip` or `base`, or empty
  Overrides overrides;           ///< keys of the profile, as in pose.tf_frame=station_2
};

/// Reads a profile, applies the registration and the overrides, and inserts the names.
/// @param path  path of the profile   @param choice  names, registration and overrides
/// @throws DeviceError, RegistrationError
DeviceProfile loadDevice(const std::string& path, const DeviceChoice& choice);
/// Parses a profile from a text. @param where  its name, for errors
DeviceProfile parseDevice(const std::string& yaml, const std::string& where, const DeviceChoice& choice);

/// Returns the stylus with its device's limits of force and torque where they are lower, and age of poses where it is
/// set.
StylusConfig withDevice(StylusConfig stylus, const DeviceProfile& device);

/// Returns the rotation from a device's axes to ours: in "x -z y", our y is the device's -z.
/// @throws DeviceError  not three signed letters, a repeated axis, or a reflection; names `key`
Eigen::Matrix3d axesOf(const std::string& axes, const std::string& key);

/// Returns the table of a profile's keys, in Markdown.
std::string deviceKeysTable();

}  // namespace viscera
