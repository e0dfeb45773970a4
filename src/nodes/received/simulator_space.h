// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ros/names.h>
#include <ros/this_node.h>

#include <string>

namespace viscera::received {

/// Returns the full name of a simulator's namespace, with a slash at its end.
/// @param space  as the user wrote it; empty: that of this node   @throws ros::InvalidNameException
inline std::string simulatorSpace(const std::string& space) {
  const std::string name = ros::names::resolve(space.empty() ? ros::this_node::getNamespace() : space);
  return name.back() == '/' ? name : name + "/";
}

}  // namespace viscera::received
