// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ros/node_handle.h>
#include <std_srvs/Trigger.h>
#include <tf2_ros/transform_listener.h>

#include <condition_variable>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "devices/device_map.h"
#include "devices/registration_file.h"
#include "nodes/hands/stylus_mailbox.h"
#include "nodes/ros/master_watch.h"
#include "nodes/ros/parameters.h"

namespace viscera::nodes {

/// What the private parameters of `register_stylus` say.
struct RegisterOptions {
  enum class Mode { kPivot, kPoints };
  Mode mode = Mode::kPivot;
  std::string stylus = "left";
  DeviceProfile device;            ///< whose units and axes poses are in; without tip, base and scale
  std::string tf_frame, tf_base;   ///< poses come from tf where both are given
  std::string file;                ///< written by `solve`
  std::vector<KnownPoint> points;  ///< of mode points
  RegistrationFile known;          ///< what the file held before: its tip is used to touch points
  double window_s = 0;             ///< poses of one `collect`
  double max_residual_m = 0, max_motion_m = 0;
};

/// @param package_folder  where config/devices are looked up
/// @throws ParameterError, RegistrationError, DeviceError
RegisterOptions registerOptions(Parameters& parameters, const std::string& package_folder);

/// Finds the tip of a stylus, or the base of its device, from poses as the device sends them. `collect`, or a press of
/// button 1, takes the poses of a span of time; `solve` fits and writes the file; `discard` forgets the last span.
class RegisterStylus {
 public:
  explicit RegisterStylus(const RegisterOptions& options);

  /// Until ROS shuts down.
  /// @throws Error  if the master is lost
  void run();

 private:
  struct Outcome {
    bool good = false;
    std::string text;
  };
  using Trigger = std_srvs::Trigger;

  void onPose(const DevicePose& pose);
  void onButtons(const std::vector<int32_t>& values);
  void lookAtTf();
  void take(const std::string& frame, const Pose& said);
  bool collect(Trigger::Request&, Trigger::Response& response);
  bool discard(Trigger::Request&, Trigger::Response& response);
  bool solve(Trigger::Request&, Trigger::Response& response);
  bool open();
  Outcome close();
  Outcome judge();
  Outcome closePoint(const std::vector<Pose>& poses);
  Outcome closePivot(const std::vector<Pose>& poses);
  Outcome solveAndSave();
  std::string next() const;

  const RegisterOptions options_;
  ros::NodeHandle node_, private_;
  tf2_ros::Buffer frames_;
  std::unique_ptr<tf2_ros::TransformListener> listener_;
  MasterWatch master_;
  DeviceMap map_;  ///< units and axes

  std::mutex mutex_;
  std::condition_variable closed_;
  bool is_open_ = false, frame_changed_ = false, pressed_ = false;
  uint64_t windows_ = 0;  ///< that were closed
  SteadyTime end_{};
  Outcome last_;
  std::string frame_;        ///< of the poses
  ros::Time tf_stamp_;       ///< of the last pose from tf
  uint64_t refused_ = 0;     ///< poses of the window that were not valid
  std::vector<Pose> poses_;  ///< of the window
  std::vector<std::vector<Pose>> pivots_;
  std::vector<Vector3d> touched_;
  RegistrationFile found_;

  ros::Subscriber pose_subscriber_, button_subscriber_;
  std::vector<ros::ServiceServer> services_;
};

}  // namespace viscera::nodes
