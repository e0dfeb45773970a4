// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <set>
#include <string>

namespace viscera::nodes {

/// Ensures that a node that roslaunch respawns runs with the same parameters. A restarted master has lost the
/// parameters of a launch file, so the node would run its defaults. Parameters given as arguments (`_scene:=heart`, as
/// in launch/training.launch) survive a respawn.
class Relaunch {
 public:
  /// @param argc, argv  arguments of main(), before ros::init()
  Relaunch(int argc, const char* const* argv);

  /// Returns the run id of the roslaunch that started this node, from its log folder; empty if none did.
  const std::string& runId() const { return run_id_; }
  bool hasParameters() const { return !given_.empty(); }
  /// Logs the private parameters that an earlier start on this master has left and the command line did not set. Logs
  /// nothing for a node that roslaunch started, since it sets the parameters itself. Call it after ros::init().
  void tellInherited() const;
  /// Checks the parameters after ros::init().
  /// @throws ParameterError  the master belongs to another run, and there are no arguments
  void requireParameters() const;

 private:
  std::string run_id_;
  std::set<std::string> given_;  ///< names of parameters that were given as arguments
};

}  // namespace viscera::nodes
