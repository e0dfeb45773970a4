// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <diagnostic_msgs/DiagnosticArray.h>

#include <array>
#include <chrono>
#include <map>
#include <string>
#include <vector>

namespace viscera::received {

struct DiscoveredStylus {
  std::string name;
  std::array<std::string, 3> modes;  ///< tool modes: idle, with button 1, with button 2
  std::string state;                 ///< description, as in tracked
  std::string force_n, nodes_touched, nodes_held;
};

/// The diagnostics of a simulator.
struct DiscoveredSimulator {
  std::string node;   ///< full name of the node
  std::string scene;  ///< name; empty: it is still being created
  std::string state;  ///< description
  std::string tick, real_time_factor, springs_cut, max_stretch;
  std::string preparing_percent;  ///< progress of the scene that is being created [%]; empty: none
  std::string recording;          ///< file of the recording; empty: none
  bool paused = false;
  std::vector<DiscoveredStylus> styluses;
  std::vector<std::string> warnings;  ///< warnings of all parts
  /// Returns the namespace of its services, with a slash at its end.
  std::string space() const { return node.substr(0, node.rfind('/') + 1); }
};

/// The simulators that publish on /diagnostics.
class DiscoveredSimulators {
 public:
  using Time = std::chrono::steady_clock::time_point;
  void take(const diagnostic_msgs::DiagnosticArray& message, Time now);
  /// Returns those that reported within kSilence, sorted by name.
  std::vector<DiscoveredSimulator> at(Time now) const;

  static constexpr std::chrono::seconds kSilence{3};  ///< patience; they report once a second

 private:
  struct Heard {
    diagnostic_msgs::DiagnosticStatus status;
    Time at;
  };
  std::map<std::string, std::map<std::string, Heard>> heard_;  ///< status by node and part
};

}  // namespace viscera::received
