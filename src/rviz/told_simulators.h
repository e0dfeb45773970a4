// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <diagnostic_msgs/DiagnosticArray.h>

#include <array>
#include <chrono>
#include <map>
#include <string>
#include <vector>

namespace viscera::rviz_plugin {

struct ToldStylus {
  std::string name;
  std::array<std::string, 3> modes;  ///< idle, with button 1, with button 2
  std::string state;                 ///< in words, as in tracked
  std::string force_n, nodes_touched, nodes_held;
};

/// What a simulator tells of itself.
struct ToldSimulator {
  std::string node;   ///< its whole name
  std::string scene;  ///< empty: it is still being made
  std::string state;  ///< in words
  std::string tick, real_time_factor, springs_cut, max_stretch;
  std::string preparing_percent;  ///< of the scene that is being made; empty: none is
  std::string recording;          ///< file; empty: none
  bool paused = false;
  std::vector<ToldStylus> styluses;
  std::vector<std::string> warnings;  ///< of all parts
  /// That its services are in, with a slash behind it.
  std::string space() const { return node.substr(0, node.rfind('/') + 1); }
};

/// The simulators that speak on /diagnostics.
class ToldSimulators {
 public:
  using Time = std::chrono::steady_clock::time_point;
  void take(const diagnostic_msgs::DiagnosticArray& message, Time now);
  /// Those that spoke within kSilence, by their names.
  std::vector<ToldSimulator> at(Time now) const;

  static constexpr std::chrono::seconds kSilence{3};  ///< they speak once a second

 private:
  struct Heard {
    diagnostic_msgs::DiagnosticStatus status;
    Time at;
  };
  std::map<std::string, std::map<std::string, Heard>> heard_;  ///< by node and part
};

}  // namespace viscera::rviz_plugin
