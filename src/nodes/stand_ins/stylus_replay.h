// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ros/node_handle.h>

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "nodes/hands/device_publisher.h"
#include "nodes/hands/held_device.h"
#include "nodes/ros/clock_watch.h"
#include "nodes/ros/master_watch.h"
#include "nodes/ros/parameters.h"
#include "nodes/simulator/simulation_clock.h"
#include "viscera/model/scene/stylus_config.h"
#include "viscera/tools/strokes.h"

namespace viscera::nodes {

/// What the private parameters of the replay say.
struct ReplayOptions {
  Strokes strokes;
  std::string frame = "tissue";  ///< frame id of the poses: ~frame, or the tissue frame of ~scene
  double rate_hz = 100;
  double delay_s = 0;  ///< before the first pose, once the simulator listens
  bool loop = false;
  bool wait_for_viewer = false;       ///< before the first pose, until someone looks at what the simulator shows
  bool reset_between_rounds = false;  ///< of a loop: calls `reset` of the simulator
  std::optional<SimulatedDeviceConfig> device;  ///< strokes are what hands intend that hold such devices
  int priority = 20;                            ///< of the loop that moves them, SCHED_FIFO; 0: ordinary
};

/// Anchored strokes are brought to the skin of the scene that the parameters choose as for the simulator.
/// @param package_folder  where config/strokes/<name>.yaml and config/scenes/<name>.yaml are looked up
/// @throws ParameterError, StrokesError, SceneError, MeshError, LatticeError
ReplayOptions replayOptions(Parameters& parameters, const std::string& package_folder);

/// Those of node `sim_device`. @throws as replayOptions()
ReplayOptions simDeviceOptions(Parameters& parameters, const std::string& package_folder);

/// Plays recorded strokes as a device driver would: `<stylus>/measured_cp`, `button1` and `button2`. Their time is that
/// of the simulation, where it sends `tick`: a hand that goes on while tissue is slow would meet it elsewhere.
class StylusReplay {
 public:
  /// @throws StrokesError  more styluses than a simulator has
  explicit StylusReplay(const ReplayOptions& options);

  /// Waits until every pose topic has a subscriber, and a viewer where one is asked for, then plays; returns at the end
  /// or when ROS shuts down.
  /// @throws Error  if the master is lost
  void run();

 private:
  bool allHeard() const;
  /// @throws Error  if the master is lost
  void check();
  void waitForOthers();
  void play(double from_s);
  void resetSimulation();
  void send(double time_s);
  void send(size_t stylus, StylusSample sample);

  const ReplayOptions options_;
  ros::NodeHandle node_;
  std::vector<StylusConfig> styluses_;             ///< only their names matter
  std::vector<DevicePublisher> devices_;           ///< [styluses]
  std::vector<std::unique_ptr<HeldDevice>> held_;  ///< [styluses]; none where poses are those of the strokes
  ros::ServiceClient reset_;
  SimulationClock simulation_;
  MasterWatch master_;
  ClockWatch clock_;
};

}  // namespace viscera::nodes
