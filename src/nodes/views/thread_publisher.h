// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ros/node_handle.h>
#include <viscera/Threads.h>

#include <string>
#include <vector>

#include "session/thread_looks.h"
#include "viscera/session/frame.h"

namespace viscera {
struct Scene;
}

namespace viscera::nodes {

/// Topic `threads`, of scenes that have any: after every tick, latched.
class ThreadPublisher {
 public:
  ThreadPublisher(ros::NodeHandle& node, const Scene& scene);
  /// There are threads, and subscribers. From any thread of the process.
  bool isWanted() const { return publisher_ && publisher_.getNumSubscribers() > 0; }
  Threads messageOf(const Frame& frame, const ros::Time& stamp) const;
  void publish(const Threads& message) { publisher_.publish(message); }

 private:
  Threads empty_;  ///< of no thread
  std::vector<std::string> names_;
  std::vector<ThreadLook> looks_;
  ros::Publisher publisher_;
};

}  // namespace viscera::nodes
