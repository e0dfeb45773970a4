// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "nodes/camera_publisher.h"

#include <utility>

namespace viscera::nodes {

CameraPublisher::CameraPublisher(image_transport::ImageTransport& transport, const CameraConfig& camera, double tick_hz)
    : camera_(camera),
      publisher_(transport.advertiseCamera(camera.name + "/image_raw", 1)),
      throttle_(camera.rate_hz, tick_hz) {}

bool CameraPublisher::pick() {
  return publisher_.getNumSubscribers() > 0 && throttle_.pick();
}

void CameraPublisher::publish(ImageFrame&& frame, const ros::Time& stamp) {
  const std::string optical_frame = opticalFrame(camera_);
  publisher_.publish(toImage(std::move(frame), optical_frame, stamp), toCameraInfo(camera_, optical_frame, stamp));
}

}  // namespace viscera::nodes
