// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ros/node_handle.h>

#include <string>

#include "nodes/ros/scene_choice.h"
#include "viscera/Samples.h"
#include "viscera/model/scene/stylus_config.h"
#include "viscera/tools/stylus.h"

namespace viscera {
struct Scene;
}

namespace viscera::nodes {

/// Publishes topic `samples`, from which `stylus_record` makes a strokes file.
class SamplesPublisher {
 public:
  /// @param choice  parameters that chose the scene
  SamplesPublisher(ros::NodeHandle& node, const Scene& scene, const SceneChoice& choice);
  /// Publishes the samples of a tick. Called on the stepping thread.
  /// @param tools       motions of the tools in the tick
  /// @param input_reset  whether input was discarded since the previous tick
  void publish(uint64_t tick, const StylusSamples& samples, const ToolMotions& tools, bool input_reset);

 private:
  const std::vector<StylusConfig> styluses_;
  std::string carried_;  ///< other objects that move the tissue all the time
  Samples message_;      ///< last message that was sent
  ros::Publisher publisher_;
};

}  // namespace viscera::nodes
