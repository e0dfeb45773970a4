// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "nodes/master_watch.h"

#include <ros/master.h>
#include <ros/this_node.h>

namespace viscera::nodes {
namespace {

constexpr std::chrono::seconds kPeriod{1};
constexpr std::chrono::seconds kPatience{5};  ///< a busy master may miss a question or two

bool masterKnowsThisNode() {
  XmlRpc::XmlRpcValue request, response, uri;
  request[0] = ros::this_node::getName();
  request[1] = ros::this_node::getName();
  return ros::master::execute("lookupNode", request, response, uri, false);
}

}  // namespace

bool MasterWatch::check() {
  const Clock::time_point now = Clock::now();
  if (now - asked_ < kPeriod) return true;
  asked_ = now;
  if (masterKnowsThisNode()) known_ = now;
  return now - known_ < kPatience;
}

}  // namespace viscera::nodes
