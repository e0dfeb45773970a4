// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "devices/device_profile.h"
#include "nodes/forces/haptic_options.h"
#include "nodes/forces/launch_limits.h"
#include "nodes/input/device_choice.h"
#include "nodes/ros/parameters.h"
#include "nodes/ros/publish_options.h"
#include "nodes/ros/scene_choice.h"
#include "viscera/model/scene/scene.h"

namespace viscera::nodes {

/// The private parameters of the simulator.
struct SimulatorOptions {
  static constexpr double kLeastSurfaceRate_hz = 0.1, kMostSurfaceRate_hz = 1000;
  std::string package_folder;                 ///< folder that contains config/
  SceneChoice choice;                         ///< parameters that chose the scene
  Scene scene;                                ///< scene; its styluses have the limits of their devices
  std::vector<DeviceProfile> devices;         ///< [styluses]
  DeviceChoices device_choices;               ///< devices by names of styluses, which another scene may also have
  std::optional<LaunchLimits> launch_limits;  ///< limits of the first scene; empty: not read yet
  std::vector<std::string> limit_notes;       ///< a line for each limit of this scene that the launch limits lowered
  PublishOptions publish;
  std::string saved_folder = "viscera_saved";  ///< folder of `save_state`, `load_state` and `save_surface`
  double saved_limit_gb = 50;                  ///< limit of all files in it [GB]
  std::string trainee;                         ///< name in reports of tasks; empty: none
  std::string record;                          ///< file or folder of a recording; empty: none
  double stall_ticks = 3;                      ///< number of tick periods without a tick after which forces are zero
  double max_transform_age_s = 0.5;            ///< largest age of a moving frame's transform [s]
  HapticOptions haptics;

  /// Loads another scene. Its styluses get the devices that were chosen for their names, and no force limits above
  /// those of the launch.
  /// @throws ParameterError, DeviceError, RegistrationError
  void take(const SceneChoice& choice, const std::string& package_folder);
};

/// Reads the parameters. Restricts this process to the files of ~scene_folders, if it is set.
/// @param package_folder  folder with config/scenes/<name>.yaml and config/devices/<name>.yaml
/// @throws ParameterError, SceneError, DeviceError, FileBoundError
SimulatorOptions simulatorOptions(Parameters& parameters, const std::string& package_folder);

}  // namespace viscera::nodes
