// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ros/callback_queue.h>
#include <ros/node_handle.h>
#include <ros/spinner.h>
#include <tf2_ros/buffer.h>

#include <atomic>
#include <exception>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "nodes/forces/obstacle_force_publisher.h"
#include "nodes/ros/end_watch.h"
#include "nodes/ros/frame_listener.h"
#include "nodes/simulator/obstacle_frames.h"
#include "nodes/simulator/preparation.h"
#include "nodes/simulator/scene_switch.h"
#include "nodes/simulator/simulation_loop.h"
#include "nodes/simulator/simulator_diagnostics.h"
#include "nodes/simulator/simulator_options.h"
#include "nodes/simulator/simulator_services.h"
#include "nodes/simulator/task_switch.h"
#include "nodes/views/camera_frames.h"
#include "nodes/views/frame_publisher.h"
#include "nodes/views/samples_publisher.h"
#ifdef VISCERA_RECONFIGURE
#include "nodes/simulator/simulator_settings.h"
#endif
#include "nodes/forces/wrench_publisher.h"
#include "nodes/input/stylus_input.h"
#include "nodes/views/tick_publisher.h"
#include "nodes/views/tool_frame_publisher.h"
#include "session/recording_switch.h"

namespace viscera::nodes {

/// The simulator node: stylus inputs, simulation loop and frame publisher, with services and diagnostics.
class Simulator {
 public:
  /// @param end, scenes, recordings  must outlive this object
  Simulator(const SimulatorOptions& options, EndWatch& end, SceneSwitch& scenes, RecordingSwitch& recordings);
  ~Simulator();

  /// Runs until the end begins or another scene replaces this one.
  /// @throws the error that ends the simulation: GpuError, MeshError, ...; Error if the master is lost
  void run();

 private:
  static SimulatorDiagnostics::Inputs makeInputs(const SimulatorOptions& options, tf2_ros::Buffer& frames);
  SimulatorServices::ModeSet modeSet();
  static std::vector<std::string> toolFrames(const Scene& scene, const std::string& prefix);
  std::vector<const StylusMailbox*> mailboxes() const;
  LoopPorts ports();
  FrameRequest placed(FrameRequest outputs) const;
  void deliver(Frame&& frame, const StylusSamples& samples, bool live);
  /// Stops forces at once, and ends the node when run() sees the error.
  void fail(std::exception_ptr error);
  void listen();
  void warnOfStalls();
  void warnOfRecording();
  void reportProgress(const std::string& stage, double fraction);
  int preparingPercent() const;
  void tellFailure(const std::string& why);
  /// Ends everything that ticks do not need, while they continue, because another simulator waits to replace this one.
  void stepAside(ros::AsyncSpinner& spinner);

  EndWatch& end_;
  SceneSwitch& scenes_;
  RecordingSwitch& recordings_;
  ros::NodeHandle node_;
  tf2_ros::Buffer frames_;
  FrameListener listener_;
  ObstacleFrames obstacles_;
  CameraFrames camera_frames_;
  ros::CallbackQueue device_queue_;  ///< queue of the inputs; must outlive them
  SimulatorDiagnostics::Inputs inputs_;
  std::mutex error_mutex_;
  std::exception_ptr error_;  ///< error of a publishing thread
  WrenchPublisher wrenches_;
  EndWatch::Act release_;
  Preparation preparation_;  ///< used on the simulation thread
  ToolFramePublisher tool_frames_;
  FramePublisher publisher_;
  TickPublisher ticks_;
  SamplesPublisher samples_;
  ObstacleForcePublisher obstacle_forces_;
  std::atomic<int> preparing_percent_{0};
  std::atomic<bool> ready_{false};  ///< whether the session exists, so that devices may be subscribed to
  bool listening_ = false;
  uint64_t stalls_ = 0;  ///< number of stalls that were warned of
  std::string recording_fault_;
  TaskSwitch tasks_;
  SimulationLoop loop_;
#ifdef VISCERA_RECONFIGURE
  std::optional<SimulatorSettings> settings_;
#endif
  std::optional<SimulatorServices> services_;
  std::optional<SimulatorDiagnostics> diagnostics_;
  ros::AsyncSpinner device_spinner_;
};

}  // namespace viscera::nodes
