// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ros/node_handle.h>
#include <tf2_ros/transform_listener.h>

#include <atomic>
#include <memory>
#include <vector>

#include "nodes/frame_publisher.h"
#include "nodes/obstacle_frames.h"
#include "nodes/simulation_loop.h"
#include "nodes/simulator_diagnostics.h"
#include "nodes/simulator_options.h"
#include "nodes/simulator_services.h"
#include "nodes/stylus_input.h"
#include "nodes/tick_publisher.h"

namespace viscera::nodes {

/// The node: stylus inputs -> simulation loop -> frame publisher, with services and diagnostics beside it.
class Simulator {
 public:
  explicit Simulator(const SimulatorOptions& options);

  /// Runs until ROS shuts down.
  /// @throws what ends the simulation: GpuError, MeshError, ...; Error if the master is lost
  void run();

 private:
  static SimulatorDiagnostics::Inputs makeInputs(const Scene& scene, const tf2_ros::Buffer& frames);
  std::vector<const StylusMailbox*> mailboxes() const;
  LoopPorts ports();

  ros::NodeHandle node_;
  tf2_ros::Buffer frames_;
  tf2_ros::TransformListener listener_;
  ObstacleFrames obstacles_;
  SimulatorDiagnostics::Inputs inputs_;
  FramePublisher publisher_;
  TickPublisher ticks_;
  StylusSamples samples_;           ///< of the last tick; only the simulation's thread touches them
  std::atomic<bool> ready_{false};  ///< the session is made: devices may be listened to
  SimulationLoop loop_;
  SimulatorServices services_;
  SimulatorDiagnostics diagnostics_;
};

}  // namespace viscera::nodes
