// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "nodes/input/stylus_check.h"

#include <ros/this_node.h>

namespace viscera::nodes {
namespace {

/// Returns the namespace of a diagnostic status: `/sim1` for `sim1/simulator: left`.
std::string namespaceOf(const std::string& name) {
  const std::string node = (name[0] == '/' ? "" : "/") + name.substr(0, name.find(": "));
  const size_t last = node.rfind('/');
  return last == 0 ? "/" : node.substr(0, last);
}

bool isStylus(const diagnostic_msgs::DiagnosticStatus& status) {
  for (const diagnostic_msgs::KeyValue& value : status.values)
    if (value.key == "poses_accepted") return true;
  return false;
}

}  // namespace

std::string stylusReport(const diagnostic_msgs::DiagnosticStatus& status) {
  const size_t colon = status.name.find(": ");
  const bool ours =
      colon != std::string::npos && isStylus(status) && namespaceOf(status.name) == ros::this_node::getNamespace();
  return ours ? status.name.substr(colon + 2) : "";
}

StylusCheck::StylusCheck(ros::NodeHandle& node, const std::string& stylus) : stylus_(stylus) {
  const std::string topic = stylus + "/measured_cp";
  done_ = node.resolveName(topic) != node.resolveName(topic, false);
  if (!done_) diagnostics_ = node.subscribe("/diagnostics", 100, &StylusCheck::onDiagnostics, this);
}

void StylusCheck::onDiagnostics(const diagnostic_msgs::DiagnosticArray& message) {
  const std::lock_guard<std::mutex> lock(mutex_);
  for (const diagnostic_msgs::DiagnosticStatus& status : message.status) {
    const std::string stylus = stylusReport(status);
    if (stylus.empty()) continue;
    if (!heard_) heard_ = Clock::now();
    known_.insert(stylus);
  }
}

void StylusCheck::require() {
  if (done_) return;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (!heard_) return;
    done_ = known_.count(stylus_) > 0;
    if (!done_ && Clock::now() - *heard_ < kPatience) return;
    if (!done_) {
      std::string names;
      for (const std::string& name : known_) names += " " + name;
      throw StylusUnknown("parameter ~stylus: the scene has no stylus '" + stylus_ + "'; it has" + names);
    }
  }
  diagnostics_.shutdown();
}

}  // namespace viscera::nodes
