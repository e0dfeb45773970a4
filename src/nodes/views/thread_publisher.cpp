// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "nodes/views/thread_publisher.h"

#include "session/thread_looks.h"

namespace viscera::nodes {

ThreadPublisher::ThreadPublisher(ros::NodeHandle& node, const Scene& scene) {
  if (scene.threads.empty()) return;
  empty_.header.frame_id = scene.environment.tissue_frame;
  for (const ThreadConfig& thread : scene.threads) empty_.names.push_back(thread.name);
  for (const ThreadLook& look : looksOf(scene.threads)) empty_.radii_m.push_back(static_cast<float>(look.radius_m));
  publisher_ = node.advertise<Threads>("threads", 1, true);
}

Threads ThreadPublisher::messageOf(const Frame& frame, const ros::Time& stamp) const {
  Threads out = empty_;
  out.header.stamp = stamp;
  out.tick = frame.tick;
  for (const std::vector<Vector3d>& places_m : frame.threads) {
    out.nodes.push_back(static_cast<uint32_t>(places_m.size()));
    for (const Vector3d& place_m : places_m) {
      for (const double part_m : place_m) out.positions_m.push_back(static_cast<float>(part_m));
    }
  }
  return out;
}

}  // namespace viscera::nodes
