// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "nodes/views/tool_frame_publisher.h"

#include <chrono>

#include "nodes/ros/conversions.h"
#include "nodes/ros/thread_name.h"

namespace viscera::nodes {

ToolFramePublisher::ToolFramePublisher(const std::string& tissue_frame, const std::vector<std::string>& children)
    : tissue_frame_(tissue_frame), children_(children), thread_([this] { main(); }) {}

ToolFramePublisher::~ToolFramePublisher() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    stop_ = true;
  }
  changed_.notify_one();
  thread_.join();
}

void ToolFramePublisher::put(const StylusSamples& samples, const ros::Time& stamp) {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    samples_ = samples;
    stamp_ = stamp;
    put_ = true;
  }
  changed_.notify_one();
}

void ToolFramePublisher::main() {
  nameThread("tool_frames");
  constexpr std::chrono::duration<double> kPeriod(1 / kRate_hz);
  std::unique_lock<std::mutex> lock(mutex_);
  while (true) {
    changed_.wait(lock, [this] { return put_ || stop_; });
    if (stop_) return;
    put_ = false;
    const StylusSamples samples = samples_;
    const ros::Time stamp = stamp_;
    lock.unlock();
    send(samples, stamp);
    lock.lock();
    changed_.wait_for(lock, kPeriod, [this] { return stop_; });
  }
}

void ToolFramePublisher::send(const StylusSamples& samples, const ros::Time& stamp) {
  // The same stamp twice, as while /clock is stopped, would make every tf2 listener warn.
  if (stamp == last_sent_) return;
  std::vector<geometry_msgs::TransformStamped> frames;
  for (size_t s = 0; s < children_.size(); ++s) {
    if (samples[s].valid) frames.push_back(toTransform(samples[s].pose, tissue_frame_, children_[s], stamp));
  }
  if (frames.empty()) return;
  last_sent_ = stamp;
  broadcaster_.sendTransform(frames);
}

}  // namespace viscera::nodes
