// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ros/time.h>

#include <array>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "devices/device_map.h"
#include "nodes/ros/priority_mutex.h"
#include "viscera/model/scene/stylus_config.h"
#include "viscera/tools/stylus.h"

namespace viscera::nodes {

/// Why a device message was not used.
enum class Drop {
  kStampZero,         ///< stamp is 0: an invalid measurement in CRTK
  kNotFinite,         ///< NaN or Inf in the pose, or in the transform to the tissue frame
  kBadQuaternion,     ///< norm of the quaternion differs from 1 by more than kQuaternionTolerance
  kNoTransform,       ///< tf2 does not know the frame
  kOldTransform,      ///< tf2's newest transform of the frame is too old
  kRepeatedStamp,     ///< same stamp as that of a pose that is already stale: the driver hangs
  kDelayed,           ///< latency exceeds the lowest of this device by more than StylusConfig::stale_after_s
  kOutsideWorkspace,  ///< distance from the tissue frame's origin exceeds StylusConfig::workspace_m
  kNoButtons,         ///< message lacks the button or joint that the profile names
  kButtonValue,       ///< value of a button is not 0, 1 or 2
  kJawAngle,          ///< jaws are open by more than half a turn, in either direction
  kJointCount         ///< message has more or fewer joints than the arm
};
constexpr size_t kDropReasons = 12;
const char* text(Drop reason);  ///< snake_case name, as in the diagnostics

/// Largest deviation of a quaternion's norm from 1. Some trackers are off by a few percent: those are normalised,
/// others dropped.
constexpr double kQuaternionTolerance = 0.1;
/// Returns whether a quaternion is a unit quaternion within the tolerance. False also if its norm overflows.
inline bool isUnit(const Quaterniond& q) {
  return std::abs(q.norm() - 1) <= kQuaternionTolerance;
}

/// A pose as a device reports it, in its own units and axes.
struct DevicePose {
  Pose pose;
  std::string frame;  ///< frame of the pose; empty: the tissue frame
  ros::Time stamp;
};

/// The pose of a frame.
struct FramePose {
  std::optional<Pose> in_tissue;  ///< pose in the tissue frame; empty if it is not known or too old
  bool too_old = false;
};
using FrameLookup = std::function<FramePose(const std::string& frame)>;

/// Arrival time of a message, on both clocks.
struct Arrival {
  SteadyTime steady;
  ros::Time ros;
};

struct StylusStatus {
  bool seen = false;                    ///< whether a pose was ever accepted
  bool stale = false;                   ///< whether the last accepted pose is too old
  double input_age_s = 0;               ///< time since the last accepted pose [s]
  uint64_t accepted = 0;                ///< number of accepted poses
  uint64_t button_presses_ignored = 0;  ///< number of presses that were ignored: buttons that were down when tracking
                                        ///< began, or pressed without tracking
  uint64_t base_moves = 0;  ///< number of times that the device's base jumped, after which tracking begins again
  bool clutched = false;
  std::array<uint64_t, kDropReasons> dropped{};
};

/// The frame in which a device reports its poses and takes its forces.
struct DeviceFrame {
  std::string name;
  Quaterniond from_tissue = Quaterniond::Identity();  ///< rotation from the tissue frame into this frame
  Vector3d lever_arm_m = Vector3d::Zero();            ///< from the origin of the poses to the tip, in this frame [m]
  Vector3d position = Vector3d::Zero();               ///< position of the last pose, in the device's unit
};

/// Function of a device button.
enum class ButtonRole { kButton1, kButton2, kClutch };

/// Holds the latest valid pose and the buttons of a stylus. Thread-safe: ROS callbacks write, the simulation thread
/// reads.
class StylusMailbox {
 public:
  /// @param device  device of this stylus; the default is a CRTK device
  StylusMailbox(const StylusConfig& config, const std::string& tissue_frame, const DeviceProfile& device = {});

  /// Checks a pose, transforms it to the tissue frame and stores it. @returns the reason if it was dropped
  std::optional<Drop> put(const DevicePose& said, const FrameLookup& lookup, const Arrival& now);
  /// Sets a button. A button that was down when the poses became stale, or when they begin, acts only after it was
  /// released.
  /// @param values  buttons of the message: 0 released, 1 pressed, 2 clicked   @param index  which of them
  std::optional<Drop> press(ButtonRole role, const std::vector<int32_t>& values, size_t index, SteadyTime now);
  /// Sets the joint of a gripper or of jaws: the tool's jaws open by the same angle and are closed below 0. It also
  /// presses the profile's button, with hysteresis: below one position, until above another.
  std::optional<Drop> grip(const std::vector<double>& positions, size_t index, SteadyTime now);
  /// Sets whether the pose is held: the pose of an arm stays valid, since the arm stays where it was sent. A pose that
  /// is no longer held is stale at once.
  void hold(bool held);

  /// Requires that buttons are released before they act. Called after a pause, in which there was no subscriber.
  void clearButtons();
  /// Returns the sample for a tick that begins now. A press or click between two ticks counts as one press.
  StylusSample take(SteadyTime now);

  /// Returns the newest pose without consuming anything; buttons are left out. After tracking was lost, the pose
  /// becomes valid with the first tick that takes it: one tick without a tracked stylus comes first.
  StylusSample peek(SteadyTime now) const;

  StylusStatus status(SteadyTime now) const;
  uint64_t baseMoves() const;             ///< value in status()
  uint64_t buttonPressesIgnored() const;  ///< value in status()
  DeviceFrame deviceFrame() const;
  /// Converts a pose from the tissue frame to the device's frame and units.
  Pose inDevice(const Pose& in_tissue) const;
  /// Returns whether the clutch is pressed: the user moves the device without the tool and must feel no force.
  bool clutched() const;
  /// Counts a message that was dropped elsewhere.
  std::optional<Drop> drop(Drop reason);
  const StylusConfig& config() const { return config_; }
  const DeviceProfile& device() const { return device_; }

 private:
  struct Button {
    bool held = false;
    bool pressed_since = false;  ///< whether it was pressed since the last take()
    bool must_release = false;   ///< whether it must be released before it acts
    bool heard = false;          ///< whether a message came since tracking began
    bool take();
    void end();
  };
  bool isStale(SteadyTime now) const;
  bool isLive(SteadyTime now) const { return status_.seen && !isStale(now); }
  void endButtons();
  std::optional<Drop> checkStamp(const ros::Time& stamp, const Arrival& now) const;
  void recordStamp(const ros::Time& stamp, const Arrival& now);
  double swiftest_s(SteadyTime now) const;
  void recordPosition(const std::string& frame, const Pose& base, const Pose& tip);

  const StylusConfig config_;
  const std::string tissue_frame_;
  const DeviceProfile device_;
  mutable PriorityMutex mutex_;  ///< also locked by the force thread
  DeviceMap map_;
  Pose base_;  ///< pose of the frame of the last pose
  /// State after the base jumped: one tick must report that the stylus is not tracked, since the jump is not motion.
  enum class Anew { kNo, kToTell, kLatencies };
  Anew anew_ = Anew::kNo;
  bool held_ = false;
  std::atomic<bool> gripped_{false};
  float jaw_rad_ = kNoJaw;
  Pose pose_;
  DeviceFrame device_frame_;
  SteadyTime received_{};       ///< arrival of the newest accepted stamp
  SteadyTime came_{};           ///< beginning of tracking: the first pose, ever or after stale ones
  ros::Time stamp_;             ///< newest accepted stamp
  ros::Time stamp_came_;        ///< arrival of the first pose with that stamp
  double swiftest_s_ = 0;       ///< least difference from stamp to arrival, by the device's clock and ours [s] ...
  SteadyTime swiftest_came_{};  ///< ... and the arrival of that pose
  std::array<Button, 2> buttons_;
  StylusStatus status_;
};

}  // namespace viscera::nodes
