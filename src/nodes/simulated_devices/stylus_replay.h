// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ros/node_handle.h>

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "nodes/input/device_publisher.h"
#include "nodes/input/held_device.h"
#include "nodes/ros/clock_watch.h"
#include "nodes/ros/master_watch.h"
#include "nodes/ros/parameters.h"
#include "nodes/simulator/simulation_clock.h"
#include "viscera/model/scene/stylus_config.h"
#include "viscera/tools/strokes.h"

namespace viscera::nodes {

/// The private parameters of the replay.
struct ReplayOptions {
  Strokes strokes;
  std::string frame = "tissue";  ///< frame of the poses: ~frame, or the tissue frame of ~scene
  double rate_hz = 100;
  double delay_s = 0;  ///< delay before the first pose, after the simulator has subscribed [s]
  bool loop = false;
  bool wait_for_viewer = false;       ///< whether to wait for a viewer of the simulator's output before the first pose
  bool reset_between_rounds = false;  ///< whether a loop calls `reset` of the simulator between rounds
  std::optional<SimulatedDeviceConfig> device;  ///< simulated devices; strokes are then the users' intent
  int priority = 20;                            ///< SCHED_FIFO priority of the loop; 0: ordinary scheduling
};

/// Reads the private parameters. Anchored strokes are placed on the surface of the scene, which the parameters choose
/// as for the simulator.
/// @param package_folder  folder with config/strokes/<name>.yaml and config/scenes/<name>.yaml
/// @throws ParameterError, StrokesError, SceneError, MeshError, LatticeError
ReplayOptions replayOptions(Parameters& parameters, const std::string& package_folder);

/// Reads the parameters of node `sim_device`. @throws as replayOptions()
ReplayOptions simDeviceOptions(Parameters& parameters, const std::string& package_folder);

/// Plays recorded strokes as a device driver would: `<stylus>/measured_cp`, `button1` and `button2`. It follows
/// simulated time if the simulator sends `tick`: a stylus that moves on while the simulation is slow would meet the
/// tissue elsewhere.
class StylusReplay {
 public:
  /// @throws StrokesError  more styluses than a simulator supports
  explicit StylusReplay(const ReplayOptions& options);

  /// Waits until every pose topic has a subscriber, and for a viewer if that is required, then plays. Returns at the
  /// end or when ROS shuts down.
  /// @throws Error  if the master is lost
  void run();

 private:
  bool allReceived() const;
  /// Checks the master. @throws Error  if the master is lost
  void check();
  void waitForOthers();
  void play(double from_s);
  void resetSimulation();
  void send(double time_s);
  void send(size_t stylus, StylusSample sample);

  const ReplayOptions options_;
  ros::NodeHandle node_;
  std::vector<StylusConfig> styluses_;             ///< styluses; only their names matter
  std::vector<DevicePublisher> devices_;           ///< [styluses]
  std::vector<std::unique_ptr<HeldDevice>> held_;  ///< [styluses]; empty if poses are those of the strokes
  ros::ServiceClient reset_;
  SimulationClock simulation_;
  MasterWatch master_;
  ClockWatch clock_;
};

}  // namespace viscera::nodes
