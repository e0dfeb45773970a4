// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "nodes/views/samples_publisher.h"

#include "nodes/ros/conversions.h"
#include "viscera/model/scene/scene.h"

namespace viscera::nodes {
namespace {

constexpr uint32_t kQueue =
    10000;  ///< ten seconds at the highest tick rate, a few MB; a slower recorder reports lost ticks

ToolMode modeInScene(const StylusConfig& config, const StylusSample& sample) {
  if (sample.button2) return config.button2;
  return sample.button1 ? config.button1 : config.idle;
}

}  // namespace

SamplesPublisher::SamplesPublisher(ros::NodeHandle& node, const Scene& scene, const SceneChoice& choice)
    : styluses_(scene.styluses), publisher_(node.advertise<Samples>("samples", kQueue)) {
  message_.header.frame_id = scene.environment.tissue_frame;
  message_.scene = choice.scene;
  for (const Overrides* keys : {&choice.mesh, &choice.overrides}) {
    for (const std::string& key : *keys) message_.overrides += (message_.overrides.empty() ? "" : ";") + key;
  }
  message_.tick_hz = scene.solver.tick_hz;
  for (const ObstacleConfig& obstacle : scene.obstacles)
    if (!obstacle.frame.empty()) carried_ = "obstacle '" + obstacle.name + "', which follows tf";
}

void SamplesPublisher::publish(uint64_t tick, const StylusSamples& samples, const ToolMotions& tools,
                               bool input_reset) {
  if (publisher_.getNumSubscribers() == 0) return;
  message_.header.stamp = ros::Time::now();
  message_.tick = tick;
  message_.input_reset = input_reset;
  message_.besides = carried_;
  message_.styluses.clear();
  for (size_t s = 0; s < styluses_.size(); ++s) {
    if (!samples[s].valid) continue;
    if (tools[s].mode != modeInScene(styluses_[s], samples[s]))
      message_.besides = "the mode of stylus '" + styluses_[s].name + "', which differs from the scene (set_tool_mode)";
    StylusState& state = message_.styluses.emplace_back();
    state.stylus = styluses_[s].name;
    state.pose = toMessage(samples[s].pose);
    state.button1 = samples[s].button1;
    state.button2 = samples[s].button2;
    state.has_jaw = samples[s].jaw_rad >= 0;
    state.jaw_rad = state.has_jaw ? samples[s].jaw_rad : 0;
  }
  publisher_.publish(message_);
}

}  // namespace viscera::nodes
