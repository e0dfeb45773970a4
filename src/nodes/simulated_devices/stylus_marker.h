// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <diagnostic_msgs/DiagnosticArray.h>
#include <interactive_markers/interactive_marker_server.h>
#include <interactive_markers/menu_handler.h>
#include <ros/node_handle.h>
#include <ros/steady_timer.h>
#include <viscera/SurfaceTopology.h>
#include <viscera/SurfaceVertices.h>
#include <visualization_msgs/Marker.h>

#include <chrono>
#include <mutex>
#include <optional>

#include "devices/organ_skin.h"
#include "nodes/simulated_devices/steering.h"
#include "nodes/views/markers/marker_style.h"

namespace viscera::nodes {

struct MarkerOptions {
  SteeringOptions steering;
  bool has_start = false, has_reach = false;           ///< whether they were given; otherwise they depend on the organ
  double coarse_step_m = 0.005, fine_step_m = 0.0005;  ///< step of a click [m]; fine mode scales drags likewise
};

/// Reads the private parameters. @throws ParameterError
MarkerOptions markerOptions(Parameters& parameters);

/// A stylus without a device: a marker in rviz that the mouse moves and rotates, with handles and a menu for the
/// buttons. It starts in front of the organ and shows the distance from the tip to the surface. The tip follows the
/// marker at a limited speed.
class StylusMarker {
 public:
  explicit StylusMarker(const MarkerOptions& options);
  /// Runs until ROS shuts down.
  /// @throws Error  if the master is lost
  void run();

 private:
  using Clock = std::chrono::steady_clock;
  using Message = visualization_msgs::InteractiveMarkerFeedback;
  using Feedback = visualization_msgs::InteractiveMarkerFeedbackConstPtr;
  using Menu = interactive_markers::MenuHandler;
  /// A drag of the mouse, from pressing its button until releasing it.
  struct Drag {
    Pose marker, target;  ///< poses of marker and target at its beginning
    int presses = 0;      ///< button of the stylus that it presses; 0: none
    Clock::time_point heard;
  };

  // One thread calls all functions except next().
  void onTimer();
  void watchSurface(bool wanted);
  void place();
  bool takeSkin();
  Pose startNow();
  void onDiagnostics(const diagnostic_msgs::DiagnosticArray& message);
  void show();
  void makeMenu();
  void onFeedback(const Message& feedback);
  void onMoved(const Message& feedback);
  void letGo();
  void step(double forward_m);
  void goTo(const Pose& target);
  visualization_msgs::Marker textNow();
  double step_m() const { return fine_ ? options_.fine_step_m : options_.coarse_step_m; }
  bool isPressed(size_t button) const;

  StylusSample next(double dt_s);

  MarkerOptions options_;  ///< options, with the start and the reach that depend on the organ
  ros::NodeHandle node_;
  DevicePublisher device_;
  interactive_markers::InteractiveMarkerServer server_;
  Menu menu_;
  ros::Publisher text_;
  ros::Subscriber diagnostics_, surface_, topology_;
  ros::SteadyTimer timer_;
  const Clock::time_point begun_ = Clock::now();
  SurfaceVerticesConstPtr newest_;
  OrganSkin skin_;
  MarkerStyle style_;
  bool stale_ = false;  ///< whether the displayed marker is out of date
  bool fine_ = false, warned_ = false;

  mutable std::mutex mutex_;  ///< guards the data of next(); not held during calls of the server
  bool placed_ = false;       ///< whether the start is known
  Pose target_, pose_;
  bool checked_[3] = {};  ///< [1], [2]: buttons that are checked in the menu
  std::optional<Drag> drag_;
};

}  // namespace viscera::nodes
