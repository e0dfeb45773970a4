// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "nodes/views/camera_publisher.h"
#include "nodes/ros/conversions.h"
#include "nodes/views/surface_messages.h"

#include <algorithm>
#include <utility>

namespace viscera::nodes {

namespace {
constexpr uint32_t kTicksWaiting =
    100;  // longer than for images: the messages are small, and a lost one leaves an image without a tick
}

CameraPublisher::Plain::Plain(ros::NodeHandle& node, const std::string& name, const std::vector<std::string>& images)
    : info(node.advertise<sensor_msgs::CameraInfo>(name + "/camera_info", 1)) {
  for (const std::string& image : images) pixels.push_back(node.advertise<sensor_msgs::Image>(name + "/" + image, 1));
}

uint32_t CameraPublisher::Plain::viewers() const {
  uint32_t most = info.getNumSubscribers();
  for (const ros::Publisher& image : pixels) most = std::max(most, image.getNumSubscribers());
  return most;
}

CameraPublisher::CameraPublisher(ros::NodeHandle node, const CameraConfig& camera, const std::string& frame_prefix,
                                 double tick_hz)
    : camera_(camera),
      optical_frame_(opticalFrame(camera, frame_prefix)),
      transport_(node),
      image_(transport_.advertiseCamera(camera.name + "/image_raw", 1)),
      depth_(node, camera.name + "/depth", {"image", "image_raw"}),
      label_(node, camera.name + "/label", {"image_raw"}),
      tick_(node.advertise<Tick>(camera.name + "/tick", kTicksWaiting)),
      tick_hz_(tick_hz),
      rate_hz_(camera.rate_hz),
      throttle_(camera.rate_hz, tick_hz) {
  if (!(camera.stereo_baseline_m > 0)) return;
  left_ = transport_.advertiseCamera(camera.name + "/left/image_raw", 1);
  right_ = transport_.advertiseCamera(camera.name + "/right/image_raw", 1);
}

uint32_t CameraPublisher::viewers(PictureKind kind) const {
  const bool stereo = camera_.stereo_baseline_m > 0;
  switch (kind) {
    case PictureKind::kColor:
      return image_.getNumSubscribers() + (stereo ? left_.getNumSubscribers() : 0);
    case PictureKind::kRight:
      return stereo ? right_.getNumSubscribers() : 0;
    case PictureKind::kDepth:
      return depth_.viewers();
    case PictureKind::kLabels:
      break;
  }
  return label_.viewers();
}

bool CameraPublisher::isWanted() const {
  for (size_t kind = 0; kind < kPictureKinds; ++kind) {
    if (viewers(static_cast<PictureKind>(kind)) > 0) return true;
  }
  return false;
}

/// Publishes the tick on a separate topic, since roscpp overwrites header.seq. One message serves all images of a tick.
void CameraPublisher::tellTick(uint64_t tick, const ros::Time& stamp) {
  if (tick_.getNumSubscribers() == 0 || sent_stamp_ == stamp) return;
  sent_stamp_ = stamp;
  Tick out;
  out.header.stamp = stamp;
  out.header.frame_id = optical_frame_;
  out.tick = tick;
  out.tick_s = 1 / tick_hz_;
  out.time_s = static_cast<double>(tick) * out.tick_s;
  out.viewed = true;
  tick_.publish(out);
}

void CameraPublisher::publish(ImageFrame&& frame, const ros::Time& stamp) {
  const PictureKind kind = frame.kind;
  tellTick(frame.tick, stamp);
  const auto image = boost::make_shared<const sensor_msgs::Image>(toImage(std::move(frame), optical_frame_, stamp));
  const auto info =
      boost::make_shared<const sensor_msgs::CameraInfo>(toCameraInfo(camera_, optical_frame_, stamp, kind));
  const auto publishPlain = [&](const Plain& to) {
    for (const ros::Publisher& pixels : to.pixels) pixels.publish(image);
    to.info.publish(info);
  };
  switch (kind) {
    case PictureKind::kColor:
      image_.publish(image, info);
      if (camera_.stereo_baseline_m > 0) left_.publish(image, info);
      break;
    case PictureKind::kRight:
      right_.publish(image, info);
      break;
    case PictureKind::kDepth:
      publishPlain(depth_);
      break;
    case PictureKind::kLabels:
      publishPlain(label_);
      break;
  }
}

}  // namespace viscera::nodes
