// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ros/publisher.h>

#include <vector>

namespace viscera::nodes {

/// Everything that this process publishes stays advertised as long as this lives: an object that ends meanwhile and one
/// that takes its place need neither the master nor new connections to the subscribers.
class HeldTopics {
 public:
  HeldTopics();

 private:
  std::vector<ros::Publisher> publishers_;
};

}  // namespace viscera::nodes
