// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ros/callback_queue.h>
#include <ros/node_handle.h>
#include <ros/spinner.h>
#include <std_srvs/Trigger.h>

#include <atomic>
#include <condition_variable>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include "calibration/adaptive_resolution.h"
#include "nodes/simulator/held_topics.h"
#include "nodes/simulator/made_session.h"
#include "nodes/simulator/simulator_options.h"
#include "solver/tissue/carried_tissue.h"
#include "viscera/LoadScene.h"

namespace viscera::nodes {

/// Services that replace the simulator in a running node.
/// `load_scene` loads another scene. It reads the scene and creates its session while the old one runs, so a bad scene
/// is refused and the interruption is short. The caller, which runs simulators one after another, then creates the
/// whole simulator with it. If there is no memory for both sessions, only the model is created in advance. If the new
/// scene then fails, the old one runs again, at rest.
/// `coarsen` loads the same scene with coarser lattices, if `spacing_m: auto` was too fine for the load. The tissue
/// keeps its state.
class SceneSwitch {
 public:
  /// @param running  options of the first simulator
  /// @param package_folder  folder in which scenes are looked up by name
  SceneSwitch(ros::NodeHandle node, const SimulatorOptions& running, const std::string& package_folder);
  ~SceneSwitch();
  SceneSwitch(const SceneSwitch&) = delete;
  SceneSwitch& operator=(const SceneSwitch&) = delete;

  // Called on the main thread:
  /// Returns whether the running simulator must end because a scene is ready to replace it.
  bool isRequested() const;
  /// Reports that the session of the newest simulator exists. Transfers the tissue of the previous session if this one
  /// was created for that. Called on the session's thread.
  void begin(Session& session);
  /// Reports that a session ends, on its thread.
  void leave(const Session& session);
  /// Reports that the newest simulator runs.
  void recordReady();
  /// Returns the progress of the scene that a service waits for [%]; below 0 if there is none.
  int madePercent() const { return made_percent_; }
  /// Returns the adaptive resolution of the running session.
  AdaptiveResolution& adaptiveResolution() { return adaptive_resolution_; }
  /// Returns the options of the next simulator, if there is one; then isRequested() is false.
  std::optional<SimulatorOptions> takeNext();
  /// Returns what exists of its session, once. Null if there is nothing.
  std::unique_ptr<MadeSession> takeMade();
  /// Keeps the topics of the running simulator advertised until the next one has taken over its subscribers.
  void holdTopics();
  /// Keeps an ended session until the next one runs, unless its memory is needed.
  void retire(std::unique_ptr<MadeSession> ended);
  /// Reports that the newest simulator has ended. @returns whether it never ran and takeNext() returns the previous one
  bool goBack(const std::string& error);

 private:
  enum class State { kRunning, kRequested, kStarting, kReturning, kEnd };
  bool onLoadScene(LoadScene::Request& request, LoadScene::Response& response);
  bool onCoarsen(std_srvs::Trigger::Request& request, std_srvs::Trigger::Response& response);
  template <class Response>
  void serve(const char* service, const std::function<SimulatorOptions()>& choose, bool carries, Response& response);
  SimulatorOptions check(const LoadScene::Request& request) const;
  std::unique_ptr<MadeSession> make(const char* service, const Scene& scene) const;
  std::string change(const SimulatorOptions& next, std::unique_ptr<MadeSession> made, bool carries);
  void endOld();

  const std::string package_folder_;
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  State state_ = State::kStarting;
  SimulatorOptions running_;  ///< options of the simulator that ran last
  std::optional<SimulatorOptions> next_;
  std::unique_ptr<MadeSession> made_, retired_;
  std::unique_ptr<HeldTopics> topics_;
  bool carries_ = false;                  ///< whether the next session takes over the tissue of this one
  std::optional<CarriedTissue> carried_;  ///< tissue that is being transferred
  mutable std::atomic<int> made_percent_{-1};
  std::string error_;  ///< reason why the last simulator did not run; empty: it runs
  bool first_ = true;  ///< whether no simulator has run yet
  ros::CallbackQueue queue_;
  AdaptiveResolution adaptive_resolution_;
  ros::ServiceServer load_scene_, coarsen_;
  ros::AsyncSpinner spinner_;
};

}  // namespace viscera::nodes
