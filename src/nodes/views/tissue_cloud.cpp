// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "nodes/views/tissue_cloud.h"

#include <cstring>

namespace viscera::nodes {
namespace {

constexpr std::chrono::milliseconds kCloudEvery{200};

}  // namespace

sensor_msgs::PointCloud2 toCloud(const std::vector<NodeLoad>& loads, const std::string& frame, const ros::Time& stamp) {
  sensor_msgs::PointCloud2 cloud;
  cloud.header.frame_id = frame;
  cloud.header.stamp = stamp;
  for (const char* const name : {"x", "y", "z", "strain", "force"}) {
    sensor_msgs::PointField& field = cloud.fields.emplace_back();
    field.name = name;
    field.offset = static_cast<uint32_t>(sizeof(float) * (cloud.fields.size() - 1));
    field.datatype = sensor_msgs::PointField::FLOAT32;
    field.count = 1;
  }
  cloud.height = 1;
  cloud.width = static_cast<uint32_t>(loads.size());
  cloud.point_step = static_cast<uint32_t>(sizeof(float) * cloud.fields.size());
  cloud.row_step = cloud.point_step * cloud.width;
  cloud.is_dense = true;
  cloud.data.resize(cloud.row_step);
  uint8_t* out = cloud.data.data();
  for (const NodeLoad& load : loads) {
    const float values[] = {load.position_m.x(), load.position_m.y(), load.position_m.z(), load.strain, load.force_n};
    std::memcpy(out, values, sizeof values);
    out += sizeof values;
  }
  return cloud;
}

TissueCloud::TissueCloud(ros::NodeHandle& node, const std::string& frame)
    : frame_(frame), publisher_(node.advertise<sensor_msgs::PointCloud2>("tissue_cloud", 1)) {}

bool TissueCloud::isDue() {
  const auto now = std::chrono::steady_clock::now();
  if (!isWanted() || now < due_) return false;
  due_ = now + kCloudEvery;
  return true;
}

sensor_msgs::PointCloud2 TissueCloud::messageOf(const Session& session, const ros::Time& stamp) {
  if (!loads_ || &loads_->model() != &session.model()) loads_ = std::make_unique<NodeLoads>(session.model());
  return toCloud(loads_->of(session.solver().readState()), frame_, stamp);
}

}  // namespace viscera::nodes
