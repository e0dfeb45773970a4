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

// What a person's motions tell of a device, whatever its profile says. No ROS here: who listens to the device hands
// over what was heard.

/// A pose as the device told it.
struct HeardPose {
  double came_s = 0;  ///< steady clock
  /// Of its message, ROS time; nothing where messages of its type have none. 0 means invalid.
  std::optional<double> stamp_s;
  double clock_s = 0;  ///< ROS time when it came
  Pose pose;           ///< in the device's units and axes
  std::string frame;
};

/// One sentence for a person.
struct Verdict {
  enum class Grade { kRight, kNote, kWrong };
  Grade grade = Grade::kRight;
  std::string text;
  bool beyond_profile = false;  ///< the tool cannot follow the hand, whatever a profile says
};

/// Of a device that is held still: its rate, gaps, stamps, frames, quaternions and how much it trembles.
/// @param span_s  for which it was listened to
std::vector<Verdict> judgeStream(const std::vector<HeardPose>& heard, double span_s, const PosePort& port);

/// What a hand did while it was listened to: from where it was at first to where it was at last.
struct HandMotion {
  Vector3d way = Vector3d::Zero();   ///< device's units and axes
  Vector3d turn = Vector3d::Zero();  ///< [rad] about the device's axes
  Pose end;
};
/// @returns nothing where fewer than kFewestPoses good poses were heard
std::optional<HandMotion> motionOf(const std::vector<HeardPose>& heard);
constexpr size_t kFewestPoses = 5;

/// What a person is asked to do. In the tissue frame right is +x, up +z, towards the person -y.
enum class Asked { kRight, kUp, kTowards, kTurnLeft, kTiltRight, kTiltAway };
Vector3d directionOf(Asked asked);  ///< of the way, or of the axis of the turn; tissue frame
constexpr double kAskedWay_m = 0.1, kAskedTurn_rad = 0.8;

/// The motions that were asked for and made; nothing where one was left out.
struct HandMotions {
  std::optional<HandMotion> right, up, towards, turn_left, tilt_right, tilt_away;
  std::optional<HandMotion>& of(Asked asked);
};

/// Did the hand do something that can be judged at all? @returns what is wrong, for asking again
/// @param tremble  of a place that is held still, RMS, device's units
std::optional<std::string> unclear(Asked asked, const HandMotion& motion, double tremble);
double trembleOf(const std::vector<HeardPose>& still);

/// What the tool does with this profile when the hand does what was asked: right, mirrored, along another axis, askew.
/// @param base  rotation from the frame of the device's poses to the tissue frame
Verdict judgeMotion(Asked asked, const HandMotion& motion, const DeviceProfile& profile, const Quaterniond& base);

/// What all motions together say a profile should have.
struct FoundMap {
  std::optional<double> unit_m;
  std::optional<std::string> axes, turn_axes;
  std::vector<Verdict> verdicts;  ///< of units, and where no axes fit
};
FoundMap findMap(const HandMotions& motions, const DeviceProfile& profile, const Quaterniond& base);

/// Where the shaft of an upright handle points with this profile; @returns the turn of `tip` that mends it, if any
struct FoundTip {
  Verdict verdict;
  std::optional<Quaterniond> orientation;
};
FoundTip findTip(const Pose& upright, const DeviceProfile& profile, const Quaterniond& base);

/// A value of a button.
struct HeardButton {
  ButtonPort port;
  int value = 0;
};
/// The button that went down and up again in these events, in their order; where several did, the one that changed
/// least often, and `expected` before all others.
std::optional<ButtonPort> pressedButton(const std::vector<HeardButton>& events, const ButtonPort& expected);
Verdict judgeButton(const std::vector<HeardButton>& events, const ButtonPort& expected, const std::string& name);

/// Did a force that a simulator sent oppose the hand as it went in? Both in the device's axes.
struct HeardForce {
  double came_s = 0;
  Vector3d force_n = Vector3d::Zero();
};
Verdict judgeForce(const std::vector<HeardForce>& forces, const std::vector<HeardPose>& heard);

/// A profile with what was found, as text of a file: the keys of `yaml` and over them `overrides`.
/// @param about  lines of a comment at its head
/// @throws DeviceError  what comes out is no profile
std::string correctedProfile(const std::string& yaml, const Overrides& overrides,
                             const std::vector<std::string>& about);
/// The overrides that make `profile` what was found.
Overrides correctionsOf(const FoundMap& map, const DeviceProfile& profile);

}  // namespace viscera
