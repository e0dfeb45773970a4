// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ros/callback_queue.h>
#include <ros/node_handle.h>
#include <ros/spinner.h>

#include <condition_variable>
#include <mutex>
#include <optional>
#include <string>

#include "nodes/simulator_options.h"
#include "viscera/LoadScene.h"

namespace viscera::nodes {

/// Service `load_scene`: another scene in the same node. It is read and its model is made while the old one runs, so
/// that a bad one is refused; then the whole simulator is made anew with it, by whoever runs simulators one after
/// another. One that does not come to run for another reason, such as memory of the GPU, gives way to the old scene, at
/// rest.
class SceneSwitch {
 public:
  /// @param running  of the simulator that is made first   @param package_folder  where scenes are looked up by name
  SceneSwitch(ros::NodeHandle node, const SimulatorOptions& running, const std::string& package_folder);
  ~SceneSwitch();
  SceneSwitch(const SceneSwitch&) = delete;
  SceneSwitch& operator=(const SceneSwitch&) = delete;

  // For the main thread:
  /// The running simulator is to end, as a scene waits for its place.
  bool isRequested() const;
  /// The simulator that was made last runs.
  void noteReady();
  /// What the next simulator is made of, if there is to be one; then isRequested() is false.
  std::optional<SimulatorOptions> takeNext();
  /// The simulator that was made last has ended. @returns whether it never ran and the one before is made again, by
  /// takeNext()
  bool goBack(const std::string& error);

 private:
  enum class State { kRunning, kRequested, kStarting, kReturning, kEnd };
  bool onLoadScene(LoadScene::Request& request, LoadScene::Response& response);
  SimulatorOptions check(const LoadScene::Request& request) const;
  std::string change(const SimulatorOptions& next);

  const std::string package_folder_;
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  State state_ = State::kStarting;
  SimulatorOptions running_;  ///< of the simulator that ran last
  std::optional<SimulatorOptions> next_;
  std::string error_;  ///< why the last one did not run; empty: it does
  bool first_ = true;  ///< no simulator has run yet
  ros::CallbackQueue queue_;
  ros::ServiceServer server_;
  ros::AsyncSpinner spinner_;
};

}  // namespace viscera::nodes
