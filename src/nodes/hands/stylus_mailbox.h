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

/// Why a message of a device was not used.
enum class Drop {
  kStampZero,         ///< CRTK: an invalid measurement
  kNotFinite,         ///< NaN or Inf in the pose, or in the transform to the tissue frame
  kBadQuaternion,     ///< its length is not 1 within kQuaternionTolerance
  kNoTransform,       ///< tf2 does not know the frame
  kOldTransform,      ///< what tf2 knows of the frame is too old
  kRepeatedStamp,     ///< the stamp of a pose that is stale already: the driver hangs
  kDelayed,           ///< later than StylusConfig::stale_after_s behind the swiftest pose of this device
  kOutsideWorkspace,  ///< farther than StylusConfig::workspace_m from the tissue frame's origin
  kNoButtons,         ///< a message without the button or joint that the profile names
  kButtonValue,       ///< a button with a value other than 0, 1, 2
  kJawAngle           ///< jaws that are open by more than half a turn, to either side
};
constexpr size_t kDropReasons = 11;
const char* text(Drop reason);  ///< snake_case, as in the diagnostics

/// Some trackers send quaternions that are a few percent off unit length: those are normalised, others refused.
constexpr double kQuaternionTolerance = 0.1;
/// Negated where it is refused: an overflow of the norm is no unit either.
inline bool isUnit(const Quaterniond& q) {
  return std::abs(q.norm() - 1) <= kQuaternionTolerance;
}

/// What a device says of where it is, in its own units and axes.
struct DevicePose {
  Pose pose;
  std::string frame;  ///< empty: the tissue frame
  ros::Time stamp;
};

/// Where a frame is.
struct FramePlace {
  std::optional<Pose> in_tissue;  ///< nothing if it is not known, or known from too long ago
  bool too_old = false;
};
using FrameLookup = std::function<FramePlace(const std::string& frame)>;

/// When a message came, on both clocks.
struct Arrival {
  SteadyTime steady;
  ros::Time ros;
};

struct StylusStatus {
  bool seen = false;             ///< a pose was accepted at some time
  bool stale = false;            ///< ... but too long ago
  double input_age_s = 0;        ///< since the last accepted pose
  uint64_t accepted = 0;         ///< poses
  uint64_t presses_ignored = 0;  ///< of buttons that were down when the hand came, or without a hand
  uint64_t base_moves = 0;       ///< times that the device's base leapt, and the hand appeared again
  bool clutched = false;
  std::array<uint64_t, kDropReasons> dropped{};
};

/// The frame in which a device reports its poses, and so wants its forces.
struct DeviceFrame {
  std::string name;
  Quaterniond from_tissue = Quaterniond::Identity();  ///< turns a vector of the tissue frame into this frame
  Vector3d lever_arm_m = Vector3d::Zero();            ///< from the origin of its poses to the tip, in this frame
  Vector3d position = Vector3d::Zero();               ///< of its last pose, in its own unit
};

/// What a button of a device is for.
enum class ButtonRole { kButton1, kButton2, kClutch };

/// One slot for the latest valid pose and the buttons of a stylus, between ROS callbacks and the simulation's thread.
class StylusMailbox {
 public:
  /// @param device  of this stylus; by default one that speaks CRTK
  StylusMailbox(const StylusConfig& config, const std::string& tissue_frame, const DeviceProfile& device = {});

  /// Checks a pose, brings it to the tissue frame and keeps it; or says why not. No frame means the tissue frame.
  std::optional<Drop> put(const DevicePose& said, const FrameLookup& lookup, const Arrival& now);
  /// A button ends with its hand: what was down when the poses grew stale, or is down when they begin, must be let go
  /// before it acts. @param values  of a message's buttons, 0 released, 1 pressed, 2 clicked   @param index  which
  std::optional<Drop> press(ButtonRole role, const std::vector<int32_t>& values, size_t index, SteadyTime now);
  /// A joint of a gripper or of jaws: the tool's are open as far, closed below 0. It presses the profile's button too:
  /// below one position, until above another.
  std::optional<Drop> grip(const std::vector<double>& positions, size_t index, SteadyTime now);
  /// Its pose does not grow stale, as an arm's, which stays where it was sent; or does again, and is stale at once.
  void hold(bool held);

  /// There was no listener for a while, as in a pause: buttons must be let go before they act.
  void forgetButtons();
  /// The sample for a tick that begins now. A press or click that came and went since the last tick counts for one.
  StylusSample take(SteadyTime now);

  /// The newest pose, without taking anything: buttons are left out, and it is no tick's. Where the hand appears again
  /// it is valid from the first tick on that takes it: a tick without a hand is between what was before and this.
  StylusSample peek(SteadyTime now) const;

  StylusStatus status(SteadyTime now) const;
  uint64_t baseMoves() const;       ///< as of status()
  uint64_t pressesIgnored() const;  ///< likewise
  DeviceFrame deviceFrame() const;
  /// A pose of the tissue frame as the device would tell it.
  Pose inDevice(const Pose& in_tissue) const;
  /// The hand moves without the tool: it is to feel nothing.
  bool clutched() const;
  /// Counts a message that was found unusable elsewhere.
  std::optional<Drop> drop(Drop reason);
  const StylusConfig& config() const { return config_; }
  const DeviceProfile& device() const { return device_; }

 private:
  struct Button {
    bool held = false;
    bool pressed_since = false;  ///< since the last take()
    bool must_release = false;   ///< before it acts
    bool heard = false;          ///< since the hand came
    bool take();
    void end();
  };
  bool isStale(SteadyTime now) const;
  bool isLive(SteadyTime now) const { return status_.seen && !isStale(now); }
  void endButtons();
  std::optional<Drop> checkStamp(const ros::Time& stamp, const Arrival& now) const;
  void noteStamp(const ros::Time& stamp, const Arrival& now);
  double swiftest_s(SteadyTime now) const;
  void notePlace(const std::string& frame, const Pose& base, const Pose& tip);

  const StylusConfig config_;
  const std::string tissue_frame_;
  const DeviceProfile device_;
  mutable PriorityMutex mutex_;  ///< the thread that sends forces looks in
  DeviceMap map_;
  Pose base_;  ///< where the frame of the last pose was
  /// Of a hand whose base leapt: one tick has to be told that there is none. What was before it is no motion.
  enum class Anew { kNo, kToTell, kTold };
  Anew anew_ = Anew::kNo;
  bool held_ = false;
  std::atomic<bool> gripped_{false};
  float jaw_rad_ = kNoJaw;
  Pose pose_;
  DeviceFrame device_frame_;
  SteadyTime received_{};       ///< of the newest accepted stamp
  SteadyTime came_{};           ///< the hand: the first pose, ever or after it was stale
  ros::Time stamp_;             ///< the newest accepted
  ros::Time stamp_came_;        ///< when it came
  double swiftest_s_ = 0;       ///< least time from stamp to arrival, of this device's clock and ours ...
  SteadyTime swiftest_came_{};  ///< ... of the pose that came then
  std::array<Button, 2> buttons_;
  StylusStatus status_;
};

}  // namespace viscera::nodes
