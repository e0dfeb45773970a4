// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "devices/device_profile.h"
#include "viscera/model/scene/overrides.h"

namespace viscera {

// Judges a device by the motions that a user makes, independently of its profile. No ROS here: the caller passes
// recorded messages.

/// A pose as the device sent it.
struct ReceivedPose {
  double came_s = 0;  ///< arrival on the steady clock [s]
  /// Stamp of its message, ROS time [s]; empty if the message type has none. 0 means invalid.
  std::optional<double> stamp_s;
  double clock_s = 0;  ///< arrival in ROS time [s]
  Pose pose;           ///< pose in the device's units and axes
  std::string frame;
};

/// One sentence for the user.
struct Verdict {
  enum class Grade { kRight, kNote, kWrong };
  Grade grade = Grade::kRight;
  std::string text;
  bool beyond_profile = false;  ///< whether no profile can make the tool follow the device
};

/// Judges the stream of a device that is held still: rate, gaps, stamps, frames, quaternions and tremor.
/// @param span_s  duration of the recording [s]
std::vector<Verdict> judgeStream(const std::vector<ReceivedPose>& heard, double span_s, const PosePort& port);

/// Motion of a device during a recording, from its initial to its final pose.
struct DeviceMotion {
  Vector3d displacement = Vector3d::Zero();  ///< displacement, in the device's units and axes
  Vector3d turn = Vector3d::Zero();          ///< rotation vector [rad], in the device's axes
  Pose end;
};
/// Returns the motion. @returns nothing if fewer than kFewestPoses valid poses were recorded
std::optional<DeviceMotion> motionOf(const std::vector<ReceivedPose>& heard);
constexpr size_t kFewestPoses = 5;

/// Motion that the user is prompted for. In the tissue frame right is +x, up +z, towards the user -y.
enum class Asked { kRight, kUp, kTowards, kTurnLeft, kTiltRight, kTiltAway };
Vector3d directionOf(Asked asked);  ///< direction of the displacement, or rotation axis; tissue frame
constexpr double kAskedMotion_m = 0.1, kAskedTurn_rad = 0.8;

/// Recorded motions; empty if the user skipped one.
struct DeviceMotions {
  std::optional<DeviceMotion> right, up, towards, turn_left, tilt_right, tilt_away;
  std::optional<DeviceMotion>& of(Asked asked);
};

/// Checks whether a motion is large enough to be judged. @returns an error, after which to prompt again
/// @param tremble  tremor of a position that is held still, RMS, device's units
std::optional<std::string> unclear(Asked asked, const DeviceMotion& motion, double tremble);
double trembleOf(const std::vector<ReceivedPose>& still);

/// Judges the motion of the tool under this profile: right, mirrored, along another axis, or oblique.
/// @param base  rotation from the frame of the device's poses to the tissue frame
Verdict judgeMotion(Asked asked, const DeviceMotion& motion, const DeviceProfile& profile, const Quaterniond& base);

/// Keys of a profile that fit all motions.
struct FoundMap {
  std::optional<double> unit_m;
  std::optional<std::string> axes, turn_axes;
  std::vector<Verdict> verdicts;  ///< verdicts on units, and on motions that no axes fit
};
FoundMap findMap(const DeviceMotions& motions, const DeviceProfile& profile, const Quaterniond& base);

/// Verdict on the shaft's direction for an upright handle under this profile, and the orientation of `tip` that
/// corrects it, if any.
struct FoundTip {
  Verdict verdict;
  std::optional<Quaterniond> orientation;
};
FoundTip findTip(const Pose& upright, const DeviceProfile& profile, const Quaterniond& base);

/// A value of a button.
struct ReceivedButton {
  ButtonPort port;
  int value = 0;
};
/// Returns the button that was pressed and released in these events, which are in order. If there are several:
/// `expected` if it is one of them, otherwise the one with the fewest changes.
std::optional<ButtonPort> pressedButton(const std::vector<ReceivedButton>& events, const ButtonPort& expected);
Verdict judgeButton(const std::vector<ReceivedButton>& events, const ButtonPort& expected, const std::string& name);

/// A force that a simulator sent, in the device's axes.
struct ReceivedForce {
  double came_s = 0;
  Vector3d force_n = Vector3d::Zero();
};
Verdict judgeForce(const std::vector<ReceivedForce>& forces, const std::vector<ReceivedPose>& heard);

/// Returns a profile with the corrections as YAML text: the keys of `yaml`, overridden by `overrides`.
/// @param about  lines of the comment at its beginning
/// @throws DeviceError  the result is not a valid profile
std::string correctedProfile(const std::string& yaml, const Overrides& overrides,
                             const std::vector<std::string>& about);
/// Returns the overrides that correct `profile`.
Overrides correctionsOf(const FoundMap& map, const DeviceProfile& profile);

}  // namespace viscera
