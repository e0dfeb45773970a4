// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "nodes/ros/relaunch.h"

#include <ros/console.h>
#include <ros/param.h>
#include <ros/this_node.h>

#include <algorithm>
#include <filesystem>
#include <sstream>

#include "math/one_line.h"
#include "nodes/ros/parameters.h"

namespace viscera::nodes {
namespace {

bool isUuid(const std::string& text) {
  constexpr size_t kLength = 36, kDashes = 4;
  return text.size() == kLength && std::count(text.begin(), text.end(), '-') == kDashes;
}

}  // namespace

Relaunch::Relaunch(int argc, const char* const* argv) {
  const std::string log = "__log:=";
  for (int i = 1; i < argc; ++i) {
    const std::string argument = argv[i];
    if (argument.compare(0, log.size(), log) == 0) {
      const std::string folder = std::filesystem::path(argument.substr(log.size())).parent_path().filename().string();
      if (isUuid(folder)) run_id_ = folder;
    } else if (argument.size() > 1 && argument[0] == '_' && argument[1] != '_') {
      const size_t assign = argument.find(":=");
      if (assign != std::string::npos) given_.insert(argument.substr(1, assign - 1));
    }
  }
}

void Relaunch::tellInherited() const {
  XmlRpc::XmlRpcValue values;
  if (!run_id_.empty() || !ros::param::get("~", values) || values.getType() != XmlRpc::XmlRpcValue::TypeStruct) return;
  std::ostringstream found;
  for (auto& [name, value] : values) {
    if (given_.count(name) > 0) continue;
    found << " ~" << name << "=";
    value.write(found);
  }
  if (found.str().empty()) return;
  const std::string node = ros::this_node::getName();
  ROS_WARN(
      "these parameters on the master come from an earlier start or from rosparam and are used:%s; `rosparam delete "
      "%s` "
      "removes them",
      oneLine(found.str()).c_str(), node.c_str());
}

void Relaunch::requireParameters() const {
  std::string now;
  if (run_id_.empty() || hasParameters()) return;
  if (ros::param::get("/run_id", now) && now == run_id_) return;
  throw ParameterError(
      "the ROS master was restarted after roslaunch had started this node, and its parameters are lost. Restart "
      "roslaunch, or give the parameters as arguments, as in args=\"_scene:=heart\", which every respawn gets again");
}

}  // namespace viscera::nodes
