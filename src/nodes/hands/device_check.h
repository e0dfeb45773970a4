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
#include "nodes/hands/device_ear.h"
#include "nodes/ros/end_watch.h"
#include "nodes/ros/master_watch.h"
#include "nodes/ros/parameters.h"

namespace viscera::nodes {

/// What the command line and the private parameters of `device_check` say.
struct DeviceCheckOptions {
  DeviceChoice choice;  ///< without a profile: what is published is asked for
  bool has_profile = false;
  std::string write;  ///< file of the corrected profile; empty: it is asked for
  std::string tissue_frame = "tissue";
  double window_s = 3;
  std::string package_folder;
};

/// Takes what is of this program out of the command line: `device_<stylus>:=PROFILE[:NAME]` and `--write FILE`, which
/// are no names of ROS. @throws ParameterError
DeviceCheckOptions takeArguments(std::vector<std::string>& arguments);
/// @throws ParameterError  also where `write` exists
void readParameters(Parameters& parameters, DeviceCheckOptions& options);

/// Asks a person at the terminal to move a device, says in words what is right and wrong, and writes the profile that
/// would be right.
class DeviceCheck {
 public:
  explicit DeviceCheck(const DeviceCheckOptions& options);
  /// @returns whether it was gone through to the end, and a profile helps
  /// @throws Error, DeviceError
  bool run(EndWatch& end);

 private:
  struct Left {};  ///< the person, or the end of the node, has ended it

  void chooseTopic();
  void open();
  std::string line();
  bool ask(const std::string& text);
  DeviceEar::Heard record(const std::string& meanwhile, double span_s);
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
  std::string yaml_;  ///< of the profile
  DeviceProfile device_;
  std::unique_ptr<DeviceEar> ear_;
  std::string typed_;  ///< what was read beyond the last line

  int steps_ = 0, wrong_ = 0, notes_ = 0;
  bool helps_ = true;  ///< a profile can, as far as is known
  std::vector<HeardPose> still_;
  Quaterniond base_ = Quaterniond::Identity();  ///< from the frame of the poses to the tissue frame
  bool knows_base_ = true;
  HandMotions motions_;
  Overrides corrections_;
};

}  // namespace viscera::nodes
