// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "nodes/camera_publisher.h"

#include <utility>

namespace viscera::nodes {

CameraPublisher::CameraPublisher(image_transport::ImageTransport& transport, const CameraConfig& camera,
                                 const std::string& frame_prefix, double tick_hz)
    : camera_(camera),
      optical_frame_(opticalFrame(camera, frame_prefix)),
      publisher_(transport.advertiseCamera(camera.name + "/image_raw", 1)),
      throttle_(camera.rate_hz, tick_hz) {}

bool CameraPublisher::pick() {
  return isWanted() && throttle_.pick();
}

void CameraPublisher::publish(ImageFrame&& frame, const ros::Time& stamp) {
  publisher_.publish(toImage(std::move(frame), optical_frame_, stamp), toCameraInfo(camera_, optical_frame_, stamp));
}

}  // namespace viscera::nodes
