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
#include "nodes/stand_ins/steering.h"
#include "nodes/views/marker_look.h"

namespace viscera::nodes {

struct MarkerOptions {
  SteeringOptions steering;
  bool has_start = false, has_reach = false;           ///< given; else they follow the organ
  double coarse_step_m = 0.005, fine_step_m = 0.0005;  ///< of a click; in fine steps drags are as much shorter
};

/// @throws ParameterError
MarkerOptions markerOptions(Parameters& parameters);

/// A stylus for those without a device: a marker in rviz that the mouse moves and turns, with handles and a menu for
/// the buttons. It begins in front of the organ, and says how far the tip is from the skin. The tip follows the marker
/// at a limited speed.
class StylusMarker {
 public:
  explicit StylusMarker(const MarkerOptions& options);
  /// Until ROS shuts down.
  /// @throws Error  if the master is lost
  void run();

 private:
  using Clock = std::chrono::steady_clock;
  using Message = visualization_msgs::InteractiveMarkerFeedback;
  using Feedback = visualization_msgs::InteractiveMarkerFeedbackConstPtr;
  using Menu = interactive_markers::MenuHandler;
  /// From the mouse's button going down until it is up.
  struct Drag {
    Pose marker, target;  ///< where both were
    int presses = 0;      ///< button of the stylus, 0: none
    Clock::time_point heard;
  };

  // All but next() are called by one thread.
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

  MarkerOptions options_;  ///< with the start and the reach that follow the organ
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
  MarkerLook look_;
  bool stale_ = false;  ///< what is shown is not what is to be shown
  bool fine_ = false, warned_ = false;

  mutable std::mutex mutex_;  ///< of what next() reads; not held while the server is called, which has one of its own
  bool placed_ = false;       ///< it is known where to begin
  Pose target_, pose_;
  bool checked_[3] = {};  ///< [1], [2]: buttons, in the menu
  std::optional<Drag> drag_;
};

}  // namespace viscera::nodes
