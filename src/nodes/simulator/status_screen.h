// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <string>
#include <vector>

namespace viscera::nodes {

/// The last diagnostics of one part of a node.
struct ReceivedStatus {
  std::string node;  ///< name of the node, as in sim1/simulator
  std::string part;  ///< name of the part, as in pace, or of a stylus
  int level = 0;     ///< 0 OK, 1 warning, 2 error
  std::string message;
  std::map<std::string, std::string> values;
  double age_s = 0;  ///< time since it was received [s]
};

constexpr double kSilent_s = 3;  ///< silence after which a node that sends once a second has a problem

/// Options of the screen.
struct StatusView {
  std::string simulator;   ///< name of the only simulator to show; empty: all
  std::string master_uri;  ///< URI that is shown if there is no master
  size_t columns = 100;
  double watched_s = 0;  ///< time since subscription to /diagnostics [s]
};

/// Returns whether a simulator has reported within the last kSilent_s.
bool isSimulatorKnown(const std::vector<ReceivedStatus>& statuses, const StatusView& view);

/// Returns one screen of text: for each simulator its pace, outputs, styluses and problems.
std::string statusScreen(const std::vector<ReceivedStatus>& statuses, const StatusView& view);

/// Returns the meaning of a reason for dropped poses (`dropped_<reason>` of the diagnostics); empty if it is not known.
std::string meaningOfDrop(const std::string& reason);

}  // namespace viscera::nodes
