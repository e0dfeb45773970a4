// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <tf2_ros/transform_broadcaster.h>

#include <condition_variable>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "viscera/tools/stylus.h"

namespace viscera::nodes {

/// Publishes the frames `<stylus>_tool` on /tf from a thread of its own, at most 60 times a second, and only for
/// tracked styluses.
class ToolFramePublisher {
 public:
  static constexpr double kRate_hz = 60;

  /// @param children  [styluses] names of the frames
  ToolFramePublisher(const std::string& tissue_frame, const std::vector<std::string>& children);
  ~ToolFramePublisher();
  ToolFramePublisher(const ToolFramePublisher&) = delete;
  ToolFramePublisher& operator=(const ToolFramePublisher&) = delete;

  /// @param stamp  when the samples were taken
  void put(const StylusSamples& samples, const ros::Time& stamp);

 private:
  void main();
  void send(const StylusSamples& samples, const ros::Time& stamp);

  const std::string tissue_frame_;
  const std::vector<std::string> children_;
  tf2_ros::TransformBroadcaster broadcaster_;
  ros::Time last_sent_;

  std::mutex mutex_;
  std::condition_variable changed_;
  StylusSamples samples_;
  ros::Time stamp_;
  bool put_ = false, stop_ = false;
  std::thread thread_;
};

}  // namespace viscera::nodes
