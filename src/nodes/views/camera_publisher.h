// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <image_transport/image_transport.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <string>
#include <vector>

#include "nodes/ros/throttle.h"
#include "nodes/views/shown_messages.h"
#include "viscera/Tick.h"
#include "viscera/model/scene/camera_config.h"

namespace viscera::nodes {

/// Topics of one camera: `<camera>/image_raw` and `camera_info`; of a stereo camera the same below `left` and `right`;
/// and `<camera>/depth` and `<camera>/label`, each with an `image_raw` and a `camera_info`; metres are `depth/image`
/// too, as REP 118 has it. `<camera>/tick` says which tick the pictures of a stamp show.
class CameraPublisher {
 public:
  CameraPublisher(ros::NodeHandle node, const CameraConfig& camera, const std::string& frame_prefix, double tick_hz);

  /// Subscribers to pictures of a kind. From any thread.
  uint32_t viewers(PictureKind kind) const;
  /// Some of them have subscribers.
  bool isWanted() const;
  /// Call once in a tick: whether it has subscribers and the camera's rate makes pictures due.
  bool pick() { return isWanted() && throttle_.pick(); }
  void setRate(double rate_hz) {
    rate_hz_ = rate_hz;
    throttle_.setRate(rate_hz, tick_hz_);
  }
  /// How often colours are wanted; 0 without subscribers. From any thread.
  double wantedRate_hz() const { return viewers(PictureKind::kColor) > 0 ? std::min(rate_hz_.load(), tick_hz_) : 0; }
  void publish(ImageFrame&& frame, const ros::Time& stamp);

 private:
  void tellTick(uint64_t tick, const ros::Time& stamp);
  /// Images that are no colours: none of the plugins of image_transport are for them.
  struct Plain {
    ros::Publisher info;
    std::vector<ros::Publisher> pixels;  ///< the same image under each name
    Plain(ros::NodeHandle& node, const std::string& name, const std::vector<std::string>& images);
    uint32_t viewers() const;
  };

  const CameraConfig camera_;
  const std::string optical_frame_;
  image_transport::ImageTransport transport_;
  image_transport::CameraPublisher image_;
  image_transport::CameraPublisher left_, right_;  ///< of a stereo camera; the left picture is the camera's
  Plain depth_, label_;
  ros::Publisher tick_;
  ros::Time told_stamp_;  ///< of the pictures whose tick was sent last
  const double tick_hz_;
  std::atomic<double> rate_hz_;
  Throttle throttle_;
};

}  // namespace viscera::nodes
