// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "nodes/simulator/simulator_options.h"

#include "model/scene/file_bounds.h"
#include "nodes/ros/scene_choice.h"
#include "tasks/attempt.h"

namespace viscera::nodes {

namespace {

HapticOptions hapticOptions(Parameters& parameters) {
  constexpr double kSlowest_hz = 100, kFastest_hz = 5000;  // below this, one force per tick is as good
  HapticOptions options;
  options.rate_hz = parameters.number("haptic_rate_hz", options.rate_hz, 0, kFastest_hz);
  if (options.rate_hz > 0 && options.rate_hz < kSlowest_hz)
    throw ParameterError("parameter ~haptic_rate_hz: must be 0, for forces once per tick, or 100..5000");
  options.delay_s = parameters.number("device_delay_s", options.delay_s, 0, 0.05);
  options.priority = static_cast<int>(parameters.number("haptic_priority", options.priority, 0, 99));
  return options;
}

/// Restricts files to the folders and those of the package; no restriction if there are no folders.
void bindFiles(std::vector<std::string> folders, const std::string& package_folder) {
  if (!folders.empty()) folders.push_back(package_folder + "/config");
  bindFilesTo(folders, "parameter ~scene_folders");
}

}  // namespace

SimulatorOptions simulatorOptions(Parameters& parameters, const std::string& package_folder) {
  SimulatorOptions options;
  bindFiles(parameters.texts("scene_folders"), package_folder);
  const SceneChoice choice = SceneChoice::read(parameters, "heart", package_folder);
  PublishOptions& publish = options.publish;
  publish.surface_rate_hz =
      parameters.number("surface_rate_hz", publish.surface_rate_hz, SimulatorOptions::kLeastSurfaceRate_hz,
                        SimulatorOptions::kMostSurfaceRate_hz);
  publish.force_arrow_m_per_n = parameters.number("force_arrow_m_per_n", publish.force_arrow_m_per_n, 0, 10);
  publish.frame_prefix = choice.frame_prefix;
  options.saved_folder = parameters.text("saved_folder", options.saved_folder);
  options.saved_limit_gb = parameters.number("saved_limit_gb", options.saved_limit_gb, 1e-6, 1e6);
  options.record = parameters.text("record", options.record);
  options.trainee = parameters.text("trainee", options.trainee);
  const std::string fault = options.trainee.empty() ? "" : traineeFault(options.trainee);
  if (!fault.empty()) throw ParameterError("parameter ~trainee: " + fault);
  options.stall_ticks = parameters.number("stall_ticks", options.stall_ticks, 1.5, 1e6);
  options.max_transform_age_s = parameters.number("max_transform_age_s", options.max_transform_age_s, 0.01, 3600);
  options.haptics = hapticOptions(parameters);
  options.device_choices = DeviceChoices::read(parameters);
  parameters.refuseOthers();
  options.take(choice, package_folder);
  options.device_choices.requireKnown(options.scene.styluses);
  return options;
}

void SimulatorOptions::take(const SceneChoice& another, const std::string& folder) {
  package_folder = folder;
  choice = another;
  scene = choice.load(package_folder);
  if (!launch_limits) launch_limits.emplace(scene.styluses, choice.overrides);
  limit_notes = launch_limits->bound(scene.styluses);
  devices = device_choices.load(scene.styluses, package_folder);
  for (size_t s = 0; s < devices.size(); ++s) scene.styluses[s] = withDevice(scene.styluses[s], devices[s]);
}

}  // namespace viscera::nodes
