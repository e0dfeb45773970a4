// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ros/node_handle.h>

#include <string>

#include "viscera/Samples.h"
#include "viscera/model/scene/scene.h"
#include "viscera/tools/stylus.h"

namespace viscera::nodes {

/// Topic `samples`, from which `stylus_record` makes a strokes file.
class SamplesPublisher {
 public:
  SamplesPublisher(ros::NodeHandle& node, const Scene& scene);
  /// After every tick, by the thread that steps.
  /// @param hands_anew  hands were forgotten since the tick before
  void publish(uint64_t tick, const StylusSamples& samples, bool hands_anew);

 private:
  const std::vector<StylusConfig> styluses_;
  Samples message_;  ///< the last that was sent
  ros::Publisher publisher_;
};

}  // namespace viscera::nodes
