// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ros/node_handle.h>
#include <viscera/Needles.h>

#include <string>
#include <vector>

#include "viscera/model/scene/scene.h"
#include "viscera/session/frame.h"

namespace viscera::nodes {

/// Converts the needles of a frame. @param scene  scene that names the frame, sutures and styluses
Needles toNeedles(const Frame& frame, const Scene& scene, const ros::Time& stamp);

/// Publishes topic `needles` after every tick, latched, for scenes that have needles.
class NeedlePublisher {
 public:
  NeedlePublisher(ros::NodeHandle& node, const Scene& scene);
  /// Returns whether there are needles and subscribers. Thread-safe.
  bool isWanted() const { return publisher_ && publisher_.getNumSubscribers() > 0; }
  Needles messageOf(const Frame& frame, const ros::Time& stamp) const { return toNeedles(frame, scene_, stamp); }
  void publish(const Needles& message) { publisher_.publish(message); }

 private:
  const Scene scene_;
  ros::Publisher publisher_;
};

}  // namespace viscera::nodes
