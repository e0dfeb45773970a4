// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ros/callback_queue.h>
#include <ros/spinner.h>

#include <memory>
#include <string>
#include <vector>

#include "nodes/forces/wrench_publisher.h"
#include "nodes/simulator/command_queue.h"
#include "nodes/simulator/settings_server.h"
#include "nodes/simulator/simulator_options.h"
#include "nodes/views/frame_publisher.h"

namespace viscera::nodes {

/// Settings that dynamic_reconfigure can change while the simulation runs: limits of forces and tool modes per stylus
/// (`~<stylus>`), image rates per camera (`~cameras/<camera>`) and the surface rate (`~`). Names, ranges and meanings
/// are those of the scene's keys. Changes are made between ticks and last until another scene is loaded.
class SimulatorSettings {
 public:
  struct Publishers {
    FramePublisher& frames;
    WrenchPublisher& wrenches;
  };
  /// @param commands, publishers  must outlive this object
  SimulatorSettings(const SimulatorOptions& options, CommandQueue& commands, const Publishers& publishers);
  ~SimulatorSettings();

  /// Records that service set_tool_mode has changed a mode.
  void recordMode(size_t stylus, ToolSwitch when, ToolMode mode);

 private:
  void change(const std::function<void(Session&)>& make);
  void addSurface(const SimulatorOptions& options);
  void addStylus(size_t stylus, const StylusConfig& config);
  void addCamera(size_t camera, const CameraConfig& config);

  CommandQueue& commands_;
  const Publishers publishers_;
  std::vector<StylusConfig> styluses_;  ///< current settings; used on the queue's thread
  ros::CallbackQueue queue_;
  std::vector<std::unique_ptr<SettingsServer>> stylus_servers_;  ///< [styluses]
  std::vector<std::unique_ptr<SettingsServer>> other_servers_;
  ros::AsyncSpinner spinner_;
};

}  // namespace viscera::nodes
