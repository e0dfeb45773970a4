// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "nodes/received/discovered_simulators.h"

#include <utility>

namespace viscera::received {
namespace {

using Status = diagnostic_msgs::DiagnosticStatus;

std::string valueOf(const Status& status, const std::string& key) {
  for (const diagnostic_msgs::KeyValue& value : status.values)
    if (value.key == key) return value.value;
  return {};
}

DiscoveredStylus stylusOf(const std::string& name, const Status& status) {
  return {name,
          {valueOf(status, "idle"), valueOf(status, "button1"), valueOf(status, "button2")},
          status.message,
          valueOf(status, "force_n"),
          valueOf(status, "nodes_touched"),
          valueOf(status, "nodes_held")};
}

}  // namespace

void DiscoveredSimulators::take(const diagnostic_msgs::DiagnosticArray& message, Time now) {
  for (const Status& status : message.status) {
    const size_t colon = status.name.find(": ");
    if (colon == std::string::npos || colon == 0) continue;
    const std::string node = (status.name[0] == '/' ? "" : "/") + status.name.substr(0, colon);
    heard_[node][status.name.substr(colon + 2)] = {status, now};
  }
  for (auto node = heard_.begin(); node != heard_.end();) {  // removes parts of a scene that was replaced
    for (auto part = node->second.begin(); part != node->second.end();)
      part = now - part->second.at > kSilence ? node->second.erase(part) : std::next(part);
    node = node->second.empty() ? heard_.erase(node) : std::next(node);
  }
}

std::vector<DiscoveredSimulator> DiscoveredSimulators::at(Time now) const {
  std::vector<DiscoveredSimulator> out;
  for (const auto& [node, parts] : heard_) {
    const auto simulation = parts.find("simulation");
    if (simulation == parts.end() || now - simulation->second.at > kSilence) continue;
    const Status& whole = simulation->second.status;
    DiscoveredSimulator found;
    found.node = node;
    found.scene = valueOf(whole, "scene");
    found.state = whole.message;
    found.tick = valueOf(whole, "tick");
    found.paused = valueOf(whole, "paused") == "True";
    found.preparing_percent = valueOf(whole, "preparing_percent");
    found.recording = valueOf(whole, "recording");
    found.springs_cut = valueOf(whole, "springs_cut");
    found.max_stretch = valueOf(whole, "max_stretch");
    for (const auto& [name, part] : parts) {
      if (now - part.at > kSilence) continue;
      if (part.status.level != Status::OK) found.warnings.push_back(name + ": " + part.status.message);
      if (name == "pace") found.real_time_factor = valueOf(part.status, "real_time_factor");
      if (!valueOf(part.status, "poses_accepted").empty()) found.styluses.push_back(stylusOf(name, part.status));
    }
    out.push_back(std::move(found));
  }
  return out;
}

}  // namespace viscera::received
