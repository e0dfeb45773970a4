// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "nodes/views/markers/suture_publisher.h"

#include "model/scene/tool_kinds.h"
#include "viscera/model/scene/scene.h"

namespace viscera::nodes {

SuturePublisher::SuturePublisher(ros::NodeHandle& node, const Scene& scene) {
  if (!hasSuturesOrClips(scene)) return;
  empty_.header.frame_id = scene.environment.tissue_frame;
  for (const SutureConfig& suture : scene.sutures) names_.push_back(suture.name);
  styles_ = stylesOf(scene);
  publisher_ = node.advertise<Sutures>("sutures", 1, true);
}

Sutures SuturePublisher::messageOf(const Frame& frame, const ros::Time& stamp) const {
  Sutures out = empty_;
  out.header.stamp = stamp;
  out.tick = frame.tick;
  for (const VisibleTube& shown : frame.sutures) {
    const bool clip = shown.part == TubeKind::kClip;
    out.names.push_back(clip ? "clip" : names_[shown.suture]);
    out.radii_m.push_back(static_cast<float>((clip ? styles_.back() : styles_[shown.suture]).radius_m));
    out.nodes.push_back(static_cast<uint32_t>(shown.positions_m.size()));
    for (const Vector3d& position_m : shown.positions_m) {
      for (const double part_m : position_m) out.positions_m.push_back(static_cast<float>(part_m));
    }
  }
  return out;
}

}  // namespace viscera::nodes
