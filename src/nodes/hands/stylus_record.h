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

/// What a simulator told of its ticks, made into strokes. No ROS beside the message.
class Recording {
 public:
  enum class Outcome {
    kTaken,    ///< the tick that was due
    kWaiting,  ///< nothing was recorded yet, and this is not the first tick after a reset
    kAnew,     ///< the first tick after a reset: what was recorded before it is gone
    kEnded     ///< this cannot be recorded: what is there ends before it, see fault()
  };
  Outcome add(const Samples& message);
  /// Why the recording ended by itself; empty: it did not.
  const std::string& fault() const { return fault_; }
  uint64_t ticks() const { return strokes_.ticks; }
  const Strokes& strokes() const { return strokes_; }

 private:
  Outcome end(const std::string& why);
  Stroke& strokeOf(const std::string& stylus);

  Strokes strokes_;
  std::string fault_;
};

/// What the private parameters of `stylus_record` say.
struct RecordOptions {
  std::string file;
  bool reset = true;   ///< calls `reset` of the simulator, as a recording begins with the first tick after one
  double seconds = 0;  ///< ends by itself after so many simulated ones; 0: never
};
/// @throws ParameterError
RecordOptions recordOptions(Parameters& parameters);

/// Records every tick of a simulator from a reset on, and writes a strokes file at the end or when `save` asks.
class StylusRecord {
 public:
  explicit StylusRecord(const RecordOptions& options);

  /// Until ROS shuts down, or the seconds are over.
  /// @throws Error  the master is lost, the recording ended by itself, or the file cannot be written
  void run();

 private:
  void onSamples(const Samples& message);
  bool save(std_srvs::Trigger::Request&, std_srvs::Trigger::Response& response);
  /// @returns how much, for people   @throws StrokesError
  std::string write();
  std::string stateHash(uint64_t tick);
  void resetSimulation();
  bool isOver();

  const RecordOptions options_;
  ros::NodeHandle node_, private_;
  MasterWatch master_;
  std::mutex mutex_;
  Recording recording_;
  ros::Time reset_at_;       ///< when a reset had been answered; 0: none was asked for
  bool want_reset_ = false;  ///< a tick was lost before the first was recorded
  ros::ServiceClient reset_, step_;
  ros::ServiceServer save_;
  ros::Subscriber samples_;
};

}  // namespace viscera::nodes
