// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ros/node_handle.h>
#include <std_srvs/Trigger.h>

#include <mutex>
#include <string>

#include "nodes/ros/master_watch.h"
#include "nodes/ros/parameters.h"
#include "viscera/Samples.h"
#include "viscera/Step.h"
#include "viscera/tools/strokes.h"

namespace viscera::nodes {

/// Strokes built from the samples that a simulator publishes. Uses no ROS except the message.
class Recording {
 public:
  enum class Outcome {
    kTaken,    ///< the tick was recorded
    kWaiting,  ///< nothing is recorded yet, and this is not the first tick after a reset
    kAnew,     ///< first tick after a reset: earlier records were discarded
    kEnded     ///< the tick cannot be recorded: the recording ends before it, see fault()
  };
  Outcome add(const Samples& message);
  /// Returns why the recording ended by itself; empty if it did not.
  const std::string& fault() const { return fault_; }
  uint64_t ticks() const { return strokes_.ticks; }
  const Strokes& strokes() const { return strokes_; }

 private:
  Outcome end(const std::string& why);
  Stroke& strokeOf(const std::string& stylus);

  Strokes strokes_;
  std::string fault_;
};

/// The private parameters of `stylus_record`.
struct RecordOptions {
  std::string file;
  bool reset = true;   ///< whether to call the simulator's `reset`, with which a recording begins
  double seconds = 0;  ///< simulated duration after which the recording ends [s]; 0: no limit
};
/// Reads the private parameters. @throws ParameterError
RecordOptions recordOptions(Parameters& parameters);

/// Records every tick of a simulator from a reset on, and writes a strokes file at the end or on `save`.
class StylusRecord {
 public:
  explicit StylusRecord(const RecordOptions& options);

  /// Runs until ROS shuts down or the duration is over.
  /// @throws Error  the master is lost, the recording ended by itself, or the file cannot be written
  void run();

 private:
  void onSamples(const Samples& message);
  bool save(std_srvs::Trigger::Request&, std_srvs::Trigger::Response& response);
  /// Writes the file. @returns a description of its length   @throws StrokesError
  std::string write();
  std::string stateHash(uint64_t tick);
  void resetSimulation();
  bool isOver();

  const RecordOptions options_;
  ros::NodeHandle node_, private_;
  MasterWatch master_;
  std::mutex mutex_;
  Recording recording_;
  ros::Time reset_at_;        ///< time at which a reset was answered; 0: none was requested
  bool needs_reset_ = false;  ///< whether to reset again: a tick was lost before the first was recorded
  ros::ServiceClient reset_, step_;
  ros::ServiceServer save_;
  ros::Subscriber samples_;
};

}  // namespace viscera::nodes
