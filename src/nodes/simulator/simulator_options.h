// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "devices/device_profile.h"
#include "nodes/forces/haptic_options.h"
#include "nodes/forces/launch_limits.h"
#include "nodes/hands/device_choice.h"
#include "nodes/ros/parameters.h"
#include "nodes/ros/publish_options.h"
#include "nodes/ros/scene_choice.h"
#include "viscera/model/scene/scene.h"

namespace viscera::nodes {

/// What the private parameters of the simulator say.
struct SimulatorOptions {
  static constexpr double kLeastSurfaceRate_hz = 0.1, kMostSurfaceRate_hz = 1000;
  std::string package_folder;                 ///< where config/ is
  SceneChoice choice;                         ///< what the scene was made of
  Scene scene;                                ///< its styluses have the limits of their devices
  std::vector<DeviceProfile> devices;         ///< [styluses]
  DeviceChoices device_choices;               ///< by the styluses' names, which another scene may have too
  std::optional<LaunchLimits> launch_limits;  ///< of the first scene; null: not read yet
  std::vector<std::string> limit_notes;       ///< a line for each limit of this scene that those have lowered
  PublishOptions publish;
  std::string saved_folder = "viscera_saved";  ///< of `save_state`, `load_state` and `save_surface`
  double saved_limit_gb = 50;                  ///< of all files in it
  std::string record;                          ///< file or folder of a recording; empty: none
  double stall_ticks = 3;                      ///< forces are zero from so many ticks without one on
  double max_transform_age_s = 0.5;            ///< of what tf knows of a frame that moves
  HapticOptions haptics;

  /// Another scene, whose styluses have the devices that were chosen for those of their names, and no limits of forces
  /// above those that the launch set.
  /// @throws ParameterError, DeviceError, RegistrationError
  void take(const SceneChoice& choice, const std::string& package_folder);
};

/// Binds this process to the files of ~scene_folders, if there are any.
/// @param package_folder  where config/scenes/<name>.yaml and config/devices/<name>.yaml are looked up
/// @throws ParameterError, SceneError, DeviceError, FileBoundError
SimulatorOptions simulatorOptions(Parameters& parameters, const std::string& package_folder);

}  // namespace viscera::nodes
