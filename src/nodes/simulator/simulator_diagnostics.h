// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <diagnostic_updater/diagnostic_updater.h>
#include <ros/node_handle.h>

#include <functional>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "calibration/adaptive_resolution.h"
#include "nodes/forces/wrench_publisher.h"
#include "nodes/input/stylus_input.h"
#include "nodes/ros/slowness.h"
#include "nodes/simulator/obstacle_frames.h"
#include "nodes/simulator/simulation_loop.h"
#include "nodes/views/camera_frames.h"
#include "nodes/views/frame_publisher.h"
#include "nodes/views/picture_watch.h"
#include "session/recording_switch.h"

namespace viscera::nodes {

/// Publishes /diagnostics once a second: health and pace of the simulation, latencies, and every stylus.
class SimulatorDiagnostics {
 public:
  using Inputs = std::vector<std::unique_ptr<StylusInput>>;

  struct Publishers {
    FramePublisher& frames;
    WrenchPublisher& wrenches;
    const RecordingSwitch& recordings;
    AdaptiveResolution& adaptive_resolution;
    std::function<int()> preparing_percent;  ///< returns the progress of a new scene [%]; below 0: none
  };

  /// @param loop, publishers, inputs, obstacles, camera_frames  must outlive this object
  SimulatorDiagnostics(ros::NodeHandle node, const Scene& scene, SimulationLoop& loop, const Publishers& publishers,
                       const Inputs& inputs, const ObstacleFrames& obstacles, const CameraFrames& camera_frames);

 private:
  using Status = diagnostic_updater::DiagnosticStatusWrapper;
  void update();
  void takeLatencies();
  void simulation(Status& status);
  void pace(Status& status);
  void watchPictures();
  void latency(Status& status);
  void stylus(size_t index, Status& status);
  void obstacles(Status& status);
  void cameras(Status& status);
  void process(const std::string& name, Status& status);
  void addProcesses();

  SimulationLoop& loop_;
  const Publishers publishers_;
  const Inputs& inputs_;
  const ObstacleFrames& obstacles_;
  const CameraFrames& camera_frames_;
  uint64_t cameras_missed_before_ = 0;
  uint64_t missed_before_ = 0;         ///< number of missed lookups of obstacles' frames
  uint64_t speed_limited_before_ = 0;  ///< number of ticks in which obstacles were limited in speed
  std::vector<std::string> cameras_;   ///< names of the cameras
  std::set<std::string> processes_;    ///< names of the processes that have a status
  const std::string scene_;            ///< name of the scene
  const double tick_s_;
  Slowness slowness_;
  PictureWatch pictures_;
  bool logged_paths_ = false;  ///< whether it was logged how images are drawn
  std::optional<LoopStatus> now_;
  FramePublisher::Latencies latencies_;
  std::vector<LatencyMeter::Reading> force_latencies_;        ///< [styluses]
  std::vector<ForceLoop::HapticStats> stats_, stats_before_;  ///< [styluses]
  std::vector<uint64_t> dropped_before_;
  diagnostic_updater::Updater updater_;
  ros::SteadyTimer timer_;
};

}  // namespace viscera::nodes
