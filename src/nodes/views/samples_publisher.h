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

/// Topic `samples`, from which `stylus_record` makes a strokes file.
class SamplesPublisher {
 public:
  /// @param choice  what the scene was made of
  SamplesPublisher(ros::NodeHandle& node, const Scene& scene, const SceneChoice& choice);
  /// After every tick, by the thread that steps.
  /// @param tools       what the styluses did in the tick
  /// @param hands_anew  hands were forgotten since the tick before
  void publish(uint64_t tick, const StylusSamples& samples, const ToolMotions& tools, bool hands_anew);

 private:
  const std::vector<StylusConfig> styluses_;
  std::string carried_;  ///< what moves the tissue besides, always
  Samples message_;      ///< the last that was sent
  ros::Publisher publisher_;
};

}  // namespace viscera::nodes
