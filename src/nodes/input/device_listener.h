// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ros/node_handle.h>
#include <tf2_ros/transform_listener.h>

#include <atomic>
#include <chrono>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "devices/device_check.h"
#include "nodes/input/frame_follower.h"

namespace viscera::nodes {

/// Records the messages from and to a device on the topics of its profile, and all other published buttons.
class DeviceListener {
 public:
  struct Heard {
    std::vector<ReceivedPose> poses;
    std::vector<ReceivedButton> buttons;
    std::vector<ReceivedForce> forces;
    double span_s = 0;
  };
  /// @param frames  must outlive this object
  DeviceListener(ros::NodeHandle& node, const DeviceProfile& device, tf2_ros::Buffer& frames);

  void begin();
  Heard end();
  bool heardPose() const { return received_pose_; }  ///< whether the driver is connected and sends poses
  bool hasForces() const { return forces_ && forces_.getNumPublishers() > 0; }  ///< whether a node sends it forces

 private:
  using Clock = std::chrono::steady_clock;
  static constexpr size_t kMost = 100000;  ///< largest number of records of each kind: 100 s of a device of 1 kHz

  void listenToAllButtons(ros::NodeHandle& node, const DeviceProfile& device);
  void listenTo(ros::NodeHandle& node, const ButtonPort& port);
  void onPose(const DevicePose& pose, bool stamped);
  void onForce(const Vector3d& force_n);
  double now() const { return std::chrono::duration<double>(Clock::now() - begun_).count(); }

  std::mutex mutex_;
  Clock::time_point begun_{};
  bool open_ = false;
  std::atomic<bool> received_pose_{false};
  Heard heard_;
  ros::Subscriber poses_, forces_;
  std::vector<ros::Subscriber> buttons_;
  std::unique_ptr<FrameFollower> follower_;
};

/// A topic of poses, and the profile that matches it.
struct PoseTopic {
  std::string topic;
  PoseType type = PoseType::kPoseStamped;
  std::string profile;  ///< profile, with the driver's name, as in geomagic:Geomagic
};
/// Returns all published topics of poses. @throws Error  the master does not answer
std::vector<PoseTopic> poseTopics();

}  // namespace viscera::nodes
