// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ros/publisher.h>

#include <vector>

namespace viscera::nodes {

/// Keeps all topics that this process publishes advertised as long as this object exists. An object that ends and its
/// successor then need neither the master nor new connections to the subscribers.
class HeldTopics {
 public:
  HeldTopics();

 private:
  std::vector<ros::Publisher> publishers_;
};

}  // namespace viscera::nodes
