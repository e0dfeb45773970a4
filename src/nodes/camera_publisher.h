// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <image_transport/image_transport.h>

#include <string>

#include "nodes/conversions.h"
#include "nodes/throttle.h"

namespace viscera::nodes {

/// Topics `<camera>/image_raw` and `<camera>/camera_info` of one camera.
class CameraPublisher {
 public:
  CameraPublisher(image_transport::ImageTransport& transport, const CameraConfig& camera,
                  const std::string& frame_prefix, double tick_hz);

  /// Subscribers. From any thread.
  uint32_t viewers() const { return publisher_.getNumSubscribers(); }
  bool isWanted() const { return viewers() > 0; }
  /// Call once in a tick: whether somebody subscribes and the camera's rate makes an image due.
  bool pick();
  void publish(ImageFrame&& frame, const ros::Time& stamp);

 private:
  const CameraConfig camera_;
  const std::string optical_frame_;
  image_transport::CameraPublisher publisher_;
  Throttle throttle_;
};

}  // namespace viscera::nodes
