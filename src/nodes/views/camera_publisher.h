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
#include "nodes/views/surface_messages.h"
#include "viscera/Tick.h"
#include "viscera/model/scene/camera_config.h"

namespace viscera::nodes {

/// Publishes the images of one camera: `<camera>/image_raw` and `camera_info`; for a stereo camera the same below
/// `left` and `right`; `<camera>/depth` and `<camera>/label`, each with an `image_raw` and a `camera_info`. Depth in
/// metres is also published as `depth/image`, following REP 118. `<camera>/tick` gives the tick of the images with the
/// same stamp.
class CameraPublisher {
 public:
  CameraPublisher(ros::NodeHandle node, const CameraConfig& camera, const std::string& frame_prefix, double tick_hz);

  /// Returns the number of subscribers to images of a kind. Thread-safe.
  uint32_t viewers(PictureKind kind) const;
  /// Returns whether any image has subscribers.
  bool isWanted() const;
  /// Returns whether images are due: there are subscribers, and the camera's rate allows it. Call it once per tick.
  bool pick() { return isWanted() && throttle_.pick(); }
  void setRate(double rate_hz) {
    rate_hz_ = rate_hz;
    throttle_.setRate(rate_hz, tick_hz_);
  }
  /// Returns the desired rate of colour images [Hz]; 0 without subscribers. Thread-safe.
  double wantedRate_hz() const { return viewers(PictureKind::kColor) > 0 ? std::min(rate_hz_.load(), tick_hz_) : 0; }
  void publish(ImageFrame&& frame, const ros::Time& stamp);

 private:
  void tellTick(uint64_t tick, const ros::Time& stamp);
  /// Images other than colour, which have no plugins of image_transport.
  struct Plain {
    ros::Publisher info;
    std::vector<ros::Publisher> pixels;  ///< publishers of the same image, one per name
    Plain(ros::NodeHandle& node, const std::string& name, const std::vector<std::string>& images);
    uint32_t viewers() const;
  };

  const CameraConfig camera_;
  const std::string optical_frame_;
  image_transport::ImageTransport transport_;
  image_transport::CameraPublisher image_;
  image_transport::CameraPublisher left_, right_;  ///< images of a stereo camera; the left image is the camera's own
  Plain depth_, label_;
  ros::Publisher tick_;
  ros::Time sent_stamp_;  ///< stamp of the last images for which a tick was sent
  const double tick_hz_;
  std::atomic<double> rate_hz_;
  Throttle throttle_;
};

}  // namespace viscera::nodes
