// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ros/node_handle.h>
#include <tf2_ros/transform_listener.h>

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "devices/device_check.h"
#include "nodes/input/device_listener.h"
#include "nodes/ros/end_watch.h"
#include "nodes/ros/master_watch.h"
#include "nodes/ros/parameters.h"

namespace viscera::nodes {

/// Options of `device_check`, from the command line and the private parameters.
struct DeviceCheckOptions {
  DeviceChoice choice;  ///< device to check; without a profile the user chooses a published topic
  bool has_profile = false;
  std::string write;  ///< file of the corrected profile; empty: the user is prompted for it
  std::string tissue_frame = "tissue";
  double window_s = 3;
  std::string package_folder;
};

/// Removes this program's own arguments from the command line: `device_<stylus>:=PROFILE[:NAME]` and `--write FILE`,
/// which are not ROS names.
/// @throws ParameterError
DeviceCheckOptions takeArguments(std::vector<std::string>& arguments);
/// Reads the private parameters. @throws ParameterError  also if the file `write` exists
void readParameters(Parameters& parameters, DeviceCheckOptions& options);

/// Guides a user at the terminal through moving a device, reports what is right and wrong, and writes a corrected
/// profile.
class DeviceCheck {
 public:
  explicit DeviceCheck(const DeviceCheckOptions& options);
  /// Runs all steps. @returns whether all were completed and a profile can correct the device
  /// @throws Error, DeviceError
  bool run(EndWatch& end);

 private:
  struct Left {};  ///< thrown when the user or the end of the node ends the check

  void chooseTopic();
  void open();
  std::string line();
  bool ask(const std::string& text);
  DeviceListener::Heard record(const std::string& meanwhile, double span_s);
  void tell(const Verdict& verdict);
  bool holdStill();
  void findBase();
  void move(Asked asked, const std::string& text);
  void judgeMap();
  void press(const ButtonPort& port, const std::string& key, const std::string& text);
  void feel();
  bool finish();
  void write(const std::string& file);
  DeviceProfile corrected() const;

  DeviceCheckOptions options_;
  EndWatch* end_ = nullptr;
  ros::NodeHandle node_;
  MasterWatch master_;
  tf2_ros::Buffer frames_;
  tf2_ros::TransformListener listener_;
  std::string yaml_;  ///< YAML text of the profile
  DeviceProfile device_;
  std::unique_ptr<DeviceListener> ear_;
  std::string typed_;  ///< input that was read beyond the last line

  int steps_ = 0, wrong_ = 0, notes_ = 0;
  bool helps_ = true;  ///< whether a profile can correct the device, as far as is known
  std::vector<ReceivedPose> still_;
  Quaterniond base_ = Quaterniond::Identity();  ///< rotation from the frame of the poses to the tissue frame
  bool knows_base_ = true;
  DeviceMotions motions_;
  Overrides corrections_;
};

}  // namespace viscera::nodes
