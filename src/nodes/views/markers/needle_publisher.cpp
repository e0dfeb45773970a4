// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "nodes/views/markers/needle_publisher.h"

#include <algorithm>

#include "nodes/ros/conversions.h"

namespace viscera::nodes {

Needles toNeedles(const Frame& frame, const Scene& scene, const ros::Time& stamp) {
  Needles out;
  out.header = toHeader(scene.environment.tissue_frame, stamp);
  out.tick = frame.tick;
  for (const NeedleState& needle : frame.needles) {
    out.sutures.push_back(scene.sutures[needle.suture].name);
    out.poses.push_back(toMessage(needle.pose));
    out.radii_m.push_back(needle.radius_m);
    out.arcs_rad.push_back(needle.arc_rad);
    out.wire_radii_m.push_back(needle.wire_radius_m);
    out.held_by.push_back(needle.stylus < scene.styluses.size() ? scene.styluses[needle.stylus].name : "");
    out.in_tissue.push_back(needle.in_tissue);
  }
  return out;
}

NeedlePublisher::NeedlePublisher(ros::NodeHandle& node, const Scene& scene) : scene_(scene) {
  const auto has = [](const SutureConfig& suture) { return suture.needle.arc != NeedleArc::kNone; };
  if (std::any_of(scene.sutures.begin(), scene.sutures.end(), has))
    publisher_ = node.advertise<Needles>("needles", 1, true);
}

}  // namespace viscera::nodes
