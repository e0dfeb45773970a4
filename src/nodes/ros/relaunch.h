// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <set>
#include <string>

namespace viscera::nodes {

/// Sees to it that a node which roslaunch starts again runs what it ran before. A master that was restarted has lost
/// the parameters of a launch file: the node would run its defaults. Those given as arguments (`_scene:=heart`, as
/// launch/training.launch does) are there again.
class Relaunch {
 public:
  /// @param argc, argv  as main() gets them, before ros::init()
  Relaunch(int argc, const char* const* argv);

  /// Of the run of roslaunch that started this node, by the folder of its log; empty if none did.
  const std::string& runId() const { return run_id_; }
  bool hasParameters() const { return !given_.empty(); }
  /// Says in the log which private parameters are in force that the command line did not give, as an earlier start on
  /// this master left them; not of a node that roslaunch started, which sets them itself. After ros::init().
  void tellInherited() const;
  /// After ros::init(). @throws ParameterError  the master is not the one of that run, and there are no such arguments
  void requireParameters() const;

 private:
  std::string run_id_;
  std::set<std::string> given_;  ///< parameters, as arguments
};

}  // namespace viscera::nodes
