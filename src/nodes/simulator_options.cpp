// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "nodes/simulator_options.h"

#include "nodes/scene_choice.h"

namespace viscera::nodes {

SimulatorOptions simulatorOptions(Parameters& parameters, const std::string& package_folder) {
  SimulatorOptions options;
  const SceneChoice choice = SceneChoice::read(parameters, "heart");
  options.surface_rate_hz = parameters.number("surface_rate_hz", options.surface_rate_hz, 0.1, 1000);
  parameters.refuseOthers();
  options.scene = choice.load(package_folder);
  return options;
}

}  // namespace viscera::nodes
