// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include <ros/package.h>

#include <chrono>
#include <exception>
#include <optional>
#include <string>
#include <utility>

#include "nodes/ros/master_watch.h"
#include "nodes/ros/node_main.h"
#include "nodes/ros/relaunch.h"
#include "nodes/simulator/scene_switch.h"
#include "nodes/simulator/simulator.h"
#include "session/recording_switch.h"

namespace viscera::nodes {
namespace {

/// Runs one scene after another, as service load_scene requests them.
void runScenes(SimulatorOptions options, const std::string& package_folder, EndWatch& end) {
  RecordingSwitch recordings(options.record);
  SceneSwitch scenes(ros::NodeHandle(), options, package_folder);
  for (;;) {
    try {
      Simulator(options, end, scenes, recordings).run();
    } catch (const MasterLost&) {
      throw;
    } catch (const std::exception& error) {
      if (!scenes.goBack(oneLine(error.what()))) throw;
    }
    std::optional<SimulatorOptions> next = scenes.takeNext();
    if (!next || end.waitFor(std::chrono::milliseconds(0))) return;
    options = std::move(*next);
    ROS_INFO("scene %s", options.scene.name.c_str());
  }
}

}  // namespace
}  // namespace viscera::nodes

int main(int argc, char** argv) {
  const viscera::nodes::Relaunch relaunch(argc, argv);  // roscpp removes arguments
  return viscera::nodes::nodeMain(argc, argv, "simulator", [&relaunch](viscera::nodes::EndWatch& end) {
    relaunch.requireParameters();
    auto parameters = viscera::nodes::Parameters::ofThisNode();
    const std::string package_folder = ros::package::getPath("viscera");
    viscera::nodes::runScenes(viscera::nodes::simulatorOptions(parameters, package_folder), package_folder, end);
  });
}
