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
#include "nodes/input/stylus_mailbox.h"
#include "nodes/ros/master_watch.h"
#include "nodes/ros/parameters.h"

namespace viscera::nodes {

/// The private parameters of `register_stylus`.
struct RegisterOptions {
  enum class Mode { kPivot, kPoints };
  Mode mode = Mode::kPivot;
  std::string stylus = "left";
  DeviceProfile device;            ///< units and axes of the poses; without tip, base and scale
  std::string tf_frame, tf_base;   ///< frame and base in tf; poses come from tf if both are set
  std::string file;                ///< file that `solve` writes
  std::vector<KnownPoint> points;  ///< known points, for mode points
  RegistrationFile known;          ///< previous contents of the file; its tip is used for touching points
  double window_s = 0;             ///< duration of one `collect` [s]
  double max_residual_m = 0, max_motion_m = 0;
};

/// Reads the private parameters. @param package_folder  folder with config/devices
/// @throws ParameterError, RegistrationError, DeviceError
RegisterOptions registerOptions(Parameters& parameters, const std::string& package_folder);

/// Calibrates the tip of a stylus, or the base of its device, from raw device poses. `collect`, or button 1, records
/// the poses of one window; `solve` fits and writes the file; `discard` removes the last window.
class RegisterStylus {
 public:
  explicit RegisterStylus(const RegisterOptions& options);

  /// Runs until ROS shuts down.
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
  void updateFromTf();
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
  uint64_t windows_ = 0;  ///< number of closed windows
  SteadyTime end_{};
  Outcome last_;
  std::string frame_;        ///< frame of the poses
  ros::Time tf_stamp_;       ///< stamp of the last pose from tf
  uint64_t refused_ = 0;     ///< number of invalid poses in the window
  std::vector<Pose> poses_;  ///< poses of the window
  std::vector<std::vector<Pose>> pivots_;
  std::vector<Vector3d> touched_;
  RegistrationFile found_;

  ros::Subscriber pose_subscriber_, button_subscriber_;
  std::vector<ros::ServiceServer> services_;
};

}  // namespace viscera::nodes
