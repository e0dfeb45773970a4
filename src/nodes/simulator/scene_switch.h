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

#include "calibration/keep_up.h"
#include "nodes/simulator/held_topics.h"
#include "nodes/simulator/made_session.h"
#include "nodes/simulator/simulator_options.h"
#include "solver/tissue/carried_tissue.h"
#include "viscera/LoadScene.h"

namespace viscera::nodes {

/// Service `load_scene`: another scene in the same node. It is read, and its session is made while the old one runs, so
/// that a bad one is refused and the old one is missed for as short as can be; then the whole simulator is made again
/// with it, by the caller, who runs simulators one after another. Where there is no room for both sessions, only the
/// model is made before. A scene that does not come to run then gives way to the old one, at rest.
/// Service `coarsen`: the same scene with coarser lattices, where `spacing_m: auto` was too fine for the load that
/// came; its tissue goes on in the state that it was in.
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
  /// The session of the simulator that was made last is there, and goes on with the tissue of the one before if it was
  /// made for that; on its thread.
  void begin(Session& session);
  /// A session ends, on its thread.
  void leave(const Session& session);
  /// The simulator that was made last runs.
  void noteReady();
  /// How much of the scene that a service waits for is made [%]; below 0: none waits.
  int madePercent() const { return made_percent_; }
  /// Of the session that runs.
  KeepUp& keepUp() { return keep_up_; }
  /// What the next simulator is made of, if there is to be one; then isRequested() is false.
  std::optional<SimulatorOptions> takeNext();
  /// What there is of its session; once. Null: nothing.
  std::unique_ptr<MadeSession> takeMade();
  /// The running simulator ends for the next one, in whose place its subscribers then find that.
  void holdTopics();
  /// A session that ran: its end waits until the next one runs, unless that needs the room.
  void bury(std::unique_ptr<MadeSession> ended);
  /// The simulator made last has ended. @returns whether it never ran and takeNext() makes the one before again
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
  SimulatorOptions running_;  ///< of the simulator that ran last
  std::optional<SimulatorOptions> next_;
  std::unique_ptr<MadeSession> made_, buried_;
  std::unique_ptr<HeldTopics> topics_;
  bool carries_ = false;                  ///< the next session goes on with the tissue of this one
  std::optional<CarriedTissue> carried_;  ///< on its way
  mutable std::atomic<int> made_percent_{-1};
  std::string error_;  ///< why the last one did not run; empty: it does
  bool first_ = true;  ///< no simulator has run yet
  ros::CallbackQueue queue_;
  KeepUp keep_up_;
  ros::ServiceServer load_scene_, coarsen_;
  ros::AsyncSpinner spinner_;
};

}  // namespace viscera::nodes
