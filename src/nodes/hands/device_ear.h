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
#include "nodes/hands/frame_follower.h"

namespace viscera::nodes {

/// Hears what a device says and is told, as its profile names it, and all other buttons there are.
class DeviceEar {
 public:
  struct Heard {
    std::vector<HeardPose> poses;
    std::vector<HeardButton> buttons;
    std::vector<HeardForce> forces;
    double span_s = 0;
  };
  /// @param frames  must outlive this
  DeviceEar(ros::NodeHandle& node, const DeviceProfile& device, tf2_ros::Buffer& frames);

  void begin();
  Heard end();
  bool heardPose() const { return heard_pose_; }  ///< the driver is connected, and tells poses
  bool hasForces() const { return forces_ && forces_.getNumPublishers() > 0; }  ///< a node sends it some

 private:
  using Clock = std::chrono::steady_clock;
  static constexpr size_t kMost = 100000;  ///< of each kind: a device of 1 kHz for 100 s

  void listenToAllButtons(ros::NodeHandle& node, const DeviceProfile& device);
  void listenTo(ros::NodeHandle& node, const ButtonPort& port);
  void onPose(const DevicePose& pose, bool stamped);
  void onForce(const Vector3d& force_n);
  double now() const { return std::chrono::duration<double>(Clock::now() - begun_).count(); }

  std::mutex mutex_;
  Clock::time_point begun_{};
  bool open_ = false;
  std::atomic<bool> heard_pose_{false};
  Heard heard_;
  ros::Subscriber poses_, forces_;
  std::vector<ros::Subscriber> buttons_;
  std::unique_ptr<FrameFollower> follower_;
};

/// A topic whose messages are poses, and the profile that it looks like.
struct PoseTopic {
  std::string topic;
  PoseType type = PoseType::kPoseStamped;
  std::string profile;  ///< and the driver's name, as in geomagic:Geomagic
};
/// All that is published. @throws Error  the master does not answer
std::vector<PoseTopic> poseTopics();

}  // namespace viscera::nodes
