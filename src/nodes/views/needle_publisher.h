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

/// @param scene  whose frame, threads and styluses are named
Needles toNeedles(const Frame& frame, const Scene& scene, const ros::Time& stamp);

/// Topic `needles`, of scenes that have any: after every tick, latched.
class NeedlePublisher {
 public:
  NeedlePublisher(ros::NodeHandle& node, const Scene& scene);
  /// There are needles, and subscribers. From any thread of the process.
  bool isWanted() const { return publisher_ && publisher_.getNumSubscribers() > 0; }
  Needles messageOf(const Frame& frame, const ros::Time& stamp) const { return toNeedles(frame, scene_, stamp); }
  void publish(const Needles& message) { publisher_.publish(message); }

 private:
  const Scene scene_;
  ros::Publisher publisher_;
};

}  // namespace viscera::nodes
