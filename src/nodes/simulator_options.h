// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "nodes/haptic_loop.h"
#include "nodes/parameters.h"
#include "nodes/publish_options.h"
#include "viscera/model/scene/scene.h"

namespace viscera::nodes {

/// What the private parameters of the simulator say.
struct SimulatorOptions {
  static constexpr double kLeastSurfaceRate_hz = 0.1, kMostSurfaceRate_hz = 1000;
  Scene scene;
  PublishOptions publish;
  double stall_ticks = 3;            ///< forces are zero from so many ticks without one on
  double max_transform_age_s = 0.5;  ///< of what tf knows of a frame that moves
  HapticOptions haptics;
};

/// @param package_folder  where config/scenes/<name>.yaml are looked up
/// @throws ParameterError, SceneError
SimulatorOptions simulatorOptions(Parameters& parameters, const std::string& package_folder);

}  // namespace viscera::nodes
