// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "nodes/views/thread_publisher.h"

#include "model/scene/tool_kinds.h"
#include "viscera/model/scene/scene.h"

namespace viscera::nodes {

ThreadPublisher::ThreadPublisher(ros::NodeHandle& node, const Scene& scene) {
  if (!hasThreadsOrClips(scene)) return;
  empty_.header.frame_id = scene.environment.tissue_frame;
  for (const ThreadConfig& thread : scene.threads) names_.push_back(thread.name);
  looks_ = looksOf(scene);
  publisher_ = node.advertise<Threads>("threads", 1, true);
}

Threads ThreadPublisher::messageOf(const Frame& frame, const ros::Time& stamp) const {
  Threads out = empty_;
  out.header.stamp = stamp;
  out.tick = frame.tick;
  for (const ShownThread& shown : frame.threads) {
    const bool clip = shown.part == ThreadPart::kClip;
    out.names.push_back(clip ? "clip" : names_[shown.thread]);
    out.radii_m.push_back(static_cast<float>((clip ? looks_.back() : looks_[shown.thread]).radius_m));
    out.nodes.push_back(static_cast<uint32_t>(shown.places_m.size()));
    for (const Vector3d& place_m : shown.places_m) {
      for (const double part_m : place_m) out.positions_m.push_back(static_cast<float>(part_m));
    }
  }
  return out;
}

}  // namespace viscera::nodes
