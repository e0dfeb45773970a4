// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "nodes/simulator_services.h"

#include <cmath>
#include <functional>
#include <utility>

#include "nodes/conversions.h"
#include "nodes/stylus_mailbox.h"
#include "viscera/math/error.h"

namespace viscera::nodes {
namespace {

constexpr std::chrono::seconds kTriggerLimit{10};  ///< a tick, however slow, and a reset
constexpr std::chrono::seconds kStepLimit{60};
constexpr uint32_t kServices = 5;  ///< one thread each

/// Where a step takes the styluses. @throws Error  a name that the scene does not have, or twice; no pose
StylusSamples samplesOf(const std::vector<StylusState>& states, const std::vector<StylusConfig>& styluses) {
  StylusSamples samples;
  for (const StylusState& state : states) {
    size_t s = 0;
    while (s < styluses.size() && styluses[s].name != state.stylus) ++s;
    if (s == styluses.size()) throw Error("styluses: the scene has no stylus '" + state.stylus + "'");
    if (samples[s].valid) throw Error("styluses: '" + state.stylus + "' is there twice");
    Pose pose = fromMessage(state.pose);
    if (!isFinite(pose) || !(std::abs(pose.orientation.norm() - 1) <= kQuaternionTolerance))
      throw Error("styluses: the pose of '" + state.stylus + "' must be finite, its quaternion of length 1");
    pose.orientation.normalize();
    if (!(pose.position_m.norm() <= styluses[s].workspace_m))
      throw Error("styluses: '" + state.stylus + "' is farther than workspace_m from the tissue frame");
    samples[s] = {true, pose, static_cast<bool>(state.button1), static_cast<bool>(state.button2)};
  }
  return samples;
}

}  // namespace

SimulatorServices::SimulatorServices(ros::NodeHandle node, const std::vector<StylusConfig>& styluses,
                                     CommandQueue& commands)
    : styluses_(styluses), commands_(commands), spinner_(kServices, &queue_) {
  node.setCallbackQueue(&queue_);
  advertiseTrigger(node, "reset", Command::Kind::kReset);
  advertiseTrigger(node, "pause", Command::Kind::kPause);
  advertiseTrigger(node, "resume", Command::Kind::kResume);
  servers_.push_back(node.advertiseService("step", &SimulatorServices::onStep, this));
  servers_.push_back(node.advertiseService("set_overlays", &SimulatorServices::onSetOverlays, this));
  spinner_.start();
}

void SimulatorServices::advertiseTrigger(ros::NodeHandle& node, const std::string& name, Command::Kind kind) {
  using Request = std_srvs::Trigger::Request;
  using Response = std_srvs::Trigger::Response;
  const boost::function<bool(Request&, Response&)> serve = [this, kind](Request&, Response& response) {
    Command command;
    command.kind = kind;
    const CommandAnswer answer = commands_.call(std::move(command), kTriggerLimit);
    response.success = answer.success;
    response.message = answer.message;
    return true;
  };
  servers_.push_back(node.advertiseService<Request, Response>(name, serve));
}

bool SimulatorServices::onSetOverlays(SetOverlays::Request& request, SetOverlays::Response& response) {
  Command command;
  command.kind = Command::Kind::kOverlays;
  command.camera = request.camera;
  try {
    command.overlays = overlaysOf(request.overlays);
  } catch (const SceneError& error) {
    response.message = std::string("overlays: ") + error.what();
    return true;
  }
  const CommandAnswer answer = commands_.call(std::move(command), kTriggerLimit);
  response.success = answer.success;
  response.message = answer.message;
  return true;
}

bool SimulatorServices::onStep(Step::Request& request, Step::Response& response) {
  Command command;
  command.kind = Command::Kind::kStep;
  command.ticks = request.ticks;
  try {
    if (!request.styluses.empty()) command.samples = samplesOf(request.styluses, styluses_);
  } catch (const Error& error) {
    response.message = error.what();
    return true;
  }
  const CommandAnswer answer = commands_.call(std::move(command), kStepLimit);
  response.success = answer.success;
  response.message = answer.message;
  response.state_hash = answer.state_hash;
  response.tick = answer.tick;
  for (const Reaction& reaction : answer.reactions) response.reactions.push_back(toMessage(reaction));
  return true;
}

}  // namespace viscera::nodes
