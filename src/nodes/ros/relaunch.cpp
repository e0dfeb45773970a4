// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "nodes/ros/relaunch.h"

#include <ros/param.h>

#include <algorithm>
#include <filesystem>

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
      has_parameters_ = has_parameters_ || argument.find(":=") != std::string::npos;
    }
  }
}

void Relaunch::requireParameters() const {
  std::string now;
  if (run_id_.empty() || has_parameters_) return;
  if (ros::param::get("/run_id", now) && now == run_id_) return;
  throw ParameterError(
      "the ROS master was restarted after roslaunch had started this node, and has lost its parameters: start "
      "roslaunch "
      "again, or give parameters as arguments, as in args=\"_scene:=heart\", which come with every respawn");
}

}  // namespace viscera::nodes
