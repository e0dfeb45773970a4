// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <interactive_markers/interactive_marker_server.h>
#include <interactive_markers/menu_handler.h>
#include <ros/node_handle.h>

#include <mutex>

#include "nodes/steering.h"

namespace viscera::nodes {

/// @throws ParameterError
SteeringOptions markerOptions(Parameters& parameters);

/// A stylus for those without a device: a marker in rviz that the mouse moves and turns, with a menu for the buttons.
/// The tip follows the marker at a limited speed.
class StylusMarker {
 public:
  explicit StylusMarker(const SteeringOptions& options);
  /// Until ROS shuts down.
  /// @throws Error  if the master is lost
  void run();

 private:
  using Feedback = visualization_msgs::InteractiveMarkerFeedbackConstPtr;
  using Menu = interactive_markers::MenuHandler;

  void makeMenu();
  void onMoved(const Feedback& feedback);
  void toggle(Menu::EntryHandle entry, bool& button);
  void goBack();
  StylusSample next(double dt_s);

  const SteeringOptions options_;
  ros::NodeHandle node_;
  DevicePublisher device_;
  interactive_markers::InteractiveMarkerServer server_;
  Menu menu_;
  std::mutex mutex_;
  Pose target_, pose_;
  bool button1_ = false, button2_ = false;
};

}  // namespace viscera::nodes
