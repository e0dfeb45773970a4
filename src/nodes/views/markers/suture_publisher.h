// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ros/node_handle.h>
#include <viscera/Sutures.h>

#include <string>
#include <vector>

#include "session/tube_styles.h"
#include "viscera/session/frame.h"

namespace viscera {
struct Scene;
}

namespace viscera::nodes {

/// Publishes topic `sutures` after every tick, latched, for scenes that have sutures.
class SuturePublisher {
 public:
  SuturePublisher(ros::NodeHandle& node, const Scene& scene);
  /// Returns whether there are sutures and subscribers. Thread-safe.
  bool isWanted() const { return publisher_ && publisher_.getNumSubscribers() > 0; }
  Sutures messageOf(const Frame& frame, const ros::Time& stamp) const;
  void publish(const Sutures& message) { publisher_.publish(message); }

 private:
  Sutures empty_;  ///< message without sutures
  std::vector<std::string> names_;
  std::vector<TubeStyle> styles_;
  ros::Publisher publisher_;
};

}  // namespace viscera::nodes
