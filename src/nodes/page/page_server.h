// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <diagnostic_msgs/DiagnosticArray.h>
#include <ros/callback_queue.h>
#include <ros/node_handle.h>
#include <tf2_ros/buffer.h>
#include <viscera/TaskState.h>
#include <visualization_msgs/MarkerArray.h>

#include <chrono>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "nodes/page/live_scene.h"
#include "nodes/page/web_server.h"
#include "nodes/received/discovered_simulators.h"
#include "nodes/received/ros_worker.h"
#include "nodes/received/surface_feed.h"
#include "nodes/ros/end_watch.h"
#include "nodes/ros/frame_listener.h"
#include "nodes/ros/parameters.h"

namespace viscera::nodes {

struct PageServerOptions {
  WebOptions web;
  double rate_hz = 30;               ///< largest rate of frames
  double force_arrow_m_per_n = 0.1;  ///< that of the simulator
};

/// Reads the private parameters. @throws ParameterError
PageServerOptions pageServerOptions(Parameters& parameters);

/// Shows the simulator of its namespace to browsers. It subscribes while a page is open, and costs nothing otherwise.
class PageServer {
 public:
  /// @throws Error  it cannot listen there
  explicit PageServer(const PageServerOptions& options);
  ~PageServer();
  /// Runs until the end begins. @throws MasterLost   @throws Error
  void run(EndWatch& end);

 private:
  using Clock = std::chrono::steady_clock;
  /// Subscriptions while a page is open.
  struct Topics {
    ros::Subscriber markers, diagnostics, task;
    std::unique_ptr<FrameListener> frames;
  };
  void follow(bool wanted);
  void update();
  std::optional<Pose> poseOf(const std::string& frame) const;
  std::string tissueFrame() const;
  nlohmann::ordered_json cameras() const;
  std::string stateText();
  void call(const std::string& service, const std::string& task);
  std::string startTask(const std::string& task);
  void refused(const std::string& why);
  void warn();

  const PageServerOptions options_;
  const std::string space_;  ///< full name of the namespace, with a slash at its end
  const std::vector<std::string> tasks_;
  ros::CallbackQueue queue_;
  ros::NodeHandle node_;
  tf2_ros::Buffer frames_;
  std::unique_ptr<Topics> topics_;
  received::SurfaceFeed feed_;
  received::DiscoveredSimulators simulators_;
  TaskState task_;
  LiveScene scene_;
  std::string state_;      ///< last text of the state
  uint64_t welcomed_ = 0;  ///< clients so far, when the last frame was made
  Clock::time_point due_{}, state_due_{}, left_{}, followed_{};
  std::mutex refused_mutex_;
  std::string last_refused_;
  uint64_t refused_ = 0, warned_ = 0;
  Clock::time_point warn_due_{};
  // Last members: their threads use all of the above.
  std::unique_ptr<WebServer> server_;
  std::unique_ptr<received::RosWorker> worker_;
};

}  // namespace viscera::nodes
