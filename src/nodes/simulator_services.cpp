// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "nodes/simulator_services.h"

#include <functional>

namespace viscera::nodes {
namespace {

constexpr std::chrono::seconds kTriggerLimit{10};  ///< a tick, however slow, and a reset
constexpr std::chrono::seconds kStepLimit{60};

}  // namespace

SimulatorServices::SimulatorServices(ros::NodeHandle node, CommandQueue& commands)
    : commands_(commands), spinner_(1, &queue_) {
  node.setCallbackQueue(&queue_);
  advertiseTrigger(node, "reset", Command::Kind::kReset);
  advertiseTrigger(node, "pause", Command::Kind::kPause);
  advertiseTrigger(node, "resume", Command::Kind::kResume);
  servers_.push_back(node.advertiseService("step", &SimulatorServices::onStep, this));
  spinner_.start();
}

void SimulatorServices::advertiseTrigger(ros::NodeHandle& node, const std::string& name, Command::Kind kind) {
  using Request = std_srvs::Trigger::Request;
  using Response = std_srvs::Trigger::Response;
  const boost::function<bool(Request&, Response&)> serve = [this, kind](Request&, Response& response) {
    const CommandAnswer answer = commands_.call(kind, 0, kTriggerLimit);
    response.success = answer.success;
    response.message = answer.message;
    return true;
  };
  servers_.push_back(node.advertiseService<Request, Response>(name, serve));
}

bool SimulatorServices::onStep(Step::Request& request, Step::Response& response) {
  const CommandAnswer answer = commands_.call(Command::Kind::kStep, request.ticks, kStepLimit);
  response.success = answer.success;
  response.message = answer.message;
  response.state_hash = answer.state_hash;
  response.tick = answer.tick;
  return true;
}

}  // namespace viscera::nodes
