// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <string>
#include <vector>

namespace viscera::nodes {

/// What /diagnostics has said last of one part of a node.
struct ToldStatus {
  std::string node;  ///< as in sim1/simulator
  std::string part;  ///< as in pace, or a stylus's name
  int level = 0;     ///< 0 well, 1 a warning, 2 an error
  std::string message;
  std::map<std::string, std::string> values;
  double age_s = 0;  ///< since it came
};

constexpr double kSilent_s = 3;  ///< of a node that sends once a second: then something is wrong

/// Where to look for simulators, and how wide the screen is.
struct StatusView {
  std::string simulator;   ///< of this node alone; empty: of all
  std::string master_uri;  ///< told where there is none
  size_t columns = 100;
  double watched_s = 0;  ///< for how long /diagnostics was listened to
};

/// Whether a simulator is among those that have told something, not longer than kSilent_s ago.
bool isSimulatorTold(const std::vector<ToldStatus>& told, const StatusView& view);

/// One screen of text: of each simulator its pace, what it sends, its hands, and what is wrong, in words.
std::string statusScreen(const std::vector<ToldStatus>& told, const StatusView& view);

/// What a reason of dropping poses (`dropped_<reason>` of the diagnostics) means; empty if it is not known.
std::string meaningOfDrop(const std::string& reason);

}  // namespace viscera::nodes
