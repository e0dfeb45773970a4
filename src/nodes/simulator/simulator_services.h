// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ros/callback_queue.h>
#include <ros/node_handle.h>
#include <ros/spinner.h>
#include <std_srvs/Trigger.h>

#include <functional>
#include <vector>

#include "nodes/simulator/command_queue.h"
#include "nodes/simulator/task_switch.h"
#include "session/recording_switch.h"
#include "viscera/FileCommand.h"
#include "viscera/SetOverlays.h"
#include "viscera/SetToolMode.h"
#include "viscera/StartTask.h"
#include "viscera/Step.h"
#include "viscera/TieSuture.h"

namespace viscera::nodes {

/// Services `reset`, `pause`, `resume`, `step`, `set_overlays`, `set_tool_mode`, `save_state`, `load_state`,
/// `save_surface`, `start_recording`, `stop_recording`, `start_task` and `end_task`. They run on threads of their own,
/// so a call that waits blocks neither input nor other calls.
class SimulatorServices {
 public:
  using ModeSet = std::function<void(size_t stylus, ToolSwitch when, ToolMode mode)>;
  struct Switches {
    RecordingSwitch& recordings;
    TaskSwitch& tasks;
  };
  /// @param styluses  of the scene   @param saved_folder  folder of all files that are written and read
  /// @param commands, switches  must outlive this object
  /// @param mode_set  called after a change of a mode, on the simulation thread
  SimulatorServices(ros::NodeHandle node, const std::vector<StylusConfig>& styluses, const SavedFolder& saved_folder,
                    CommandQueue& commands, const Switches& switches, ModeSet mode_set = {});

 private:
  void advertiseTrigger(ros::NodeHandle& node, const std::string& name, Command::Kind kind);
  /// Advertises a change without arguments. @param act  @returns the message of the response   @throws Error
  void advertiseAct(ros::NodeHandle& node, const std::string& name, const std::function<std::string(Session&)>& act);
  bool onStartTask(StartTask::Request& request, StartTask::Response& response);
  /// Acts on a file with the given absolute path. @returns the message of the response   @throws Error
  using FileAct = std::function<std::string(Session&, const std::string& path)>;
  void advertiseFile(ros::NodeHandle& node, const std::string& name, bool leaps, const FileAct& act);
  std::string loadState(Session& session, const std::string& path) const;
  bool onSetOverlays(SetOverlays::Request& request, SetOverlays::Response& response);
  bool onSetToolMode(SetToolMode::Request& request, SetToolMode::Response& response);
  bool onTieSuture(TieSuture::Request& request, TieSuture::Response& response);
  bool onStep(Step::Request& request, Step::Response& response);

  const std::vector<StylusConfig> styluses_;
  const SavedFolder saved_folder_;
  CommandQueue& commands_;
  const Switches switches_;
  const ModeSet mode_set_;
  ros::CallbackQueue queue_;
  std::vector<ros::ServiceServer> servers_;
  ros::AsyncSpinner spinner_;
};

}  // namespace viscera::nodes
