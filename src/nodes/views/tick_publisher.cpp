// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "nodes/views/tick_publisher.h"

#include <utility>

#include "viscera/model/scene/scene.h"

namespace viscera::nodes {

TickPublisher::TickPublisher(ros::NodeHandle& node, const Scene& scene, std::function<bool()> viewed)
    : viewed_(std::move(viewed)), publisher_(node.advertise<Tick>("tick", 1)) {
  tick_.header.frame_id = scene.environment.tissue_frame;
  tick_.tick_s = 1 / scene.solver.tick_hz;
}

void TickPublisher::publish(uint64_t tick) {
  if (publisher_.getNumSubscribers() == 0) return;
  tick_.header.stamp = ros::Time::now();
  tick_.tick = tick;
  tick_.time_s = static_cast<double>(tick) * tick_.tick_s;
  tick_.viewed = viewed_();
  publisher_.publish(tick_);
}

}  // namespace viscera::nodes
