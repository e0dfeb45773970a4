// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "nodes/simulator_options.h"

#include "nodes/scene_choice.h"

namespace viscera::nodes {

SimulatorOptions simulatorOptions(Parameters& parameters, const std::string& package_folder) {
  SimulatorOptions options;
  const SceneChoice choice = SceneChoice::read(parameters, "heart");
  PublishOptions& publish = options.publish;
  publish.surface_rate_hz = parameters.number("surface_rate_hz", publish.surface_rate_hz, 0.1, 1000);
  publish.force_arrow_m_per_n = parameters.number("force_arrow_m_per_n", publish.force_arrow_m_per_n, 0, 10);
  publish.frame_prefix = choice.frame_prefix;
  options.stall_ticks = parameters.number("stall_ticks", options.stall_ticks, 1.5, 1e6);
  options.max_transform_age_s = parameters.number("max_transform_age_s", options.max_transform_age_s, 0.01, 3600);
  parameters.refuseOthers();
  options.scene = choice.load(package_folder);
  return options;
}

}  // namespace viscera::nodes
