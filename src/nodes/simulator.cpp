// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "nodes/simulator.h"

#include <ros/console.h>
#include <ros/spinner.h>

#include <thread>

#include "nodes/clock_watch.h"
#include "nodes/master_watch.h"

namespace viscera::nodes {
namespace {

constexpr std::chrono::milliseconds kWatchPeriod{100};

void reportProgress(const std::string& stage, double fraction) {
  ROS_INFO_THROTTLE(1, "preparing: %s %.0f %%", stage.c_str(), 100 * fraction);
}

}  // namespace

Simulator::Simulator(const SimulatorOptions& options)
    : listener_(frames_),
      obstacles_(options.scene, frames_),
      inputs_(makeInputs(options.scene, frames_)),
      publisher_(node_, options.scene, mailboxes(), options.publish),
      ticks_(node_, options.scene, [this] { return publisher_.isViewed(); }),
      loop_(options.scene, ports(), reportProgress),
      services_(node_, loop_.commands()),
      diagnostics_(node_, options.scene, loop_, publisher_, inputs_, obstacles_) {}

SimulatorDiagnostics::Inputs Simulator::makeInputs(const Scene& scene, const tf2_ros::Buffer& frames) {
  SimulatorDiagnostics::Inputs inputs;
  for (const StylusConfig& config : scene.styluses)
    inputs.push_back(std::make_unique<StylusInput>(config, scene.environment.tissue_frame, frames));
  return inputs;
}

std::vector<const StylusMailbox*> Simulator::mailboxes() const {
  std::vector<const StylusMailbox*> out;
  for (const auto& input : inputs_) out.push_back(&input->mailbox());
  return out;
}

LoopPorts Simulator::ports() {
  LoopPorts ports;
  if (!obstacles_.empty()) ports.place = [this](Session& session) { obstacles_.apply(session); };
  ports.samples = [this] {
    const auto now = std::chrono::steady_clock::now();
    for (size_t i = 0; i < inputs_.size(); ++i) samples_[i] = inputs_[i]->mailbox().take(now);
    return samples_;
  };
  ports.wants = [this] { return publisher_.beginTick(); };
  ports.ready = [this](const Session& session) {
    ROS_INFO("ready: %zu nodes, %zu springs, %zu triangles, substep %.3g ms", session.model().activeNodes(),
             session.model().springs(), session.model().skinTriangles(), 1e3 * session.solver().dt_s());
    ROS_INFO("%s", session.backendNote().c_str());
    for (const Body& body : session.model().bodies)
      for (const std::string& note : body.notes) ROS_INFO("%s: %s", body.name.c_str(), note.c_str());
    publisher_.start(session.wholeSkin());
    ready_ = true;
  };
  ports.deliver = [this](Frame&& frame) {
    ticks_.publish(frame.tick);
    publisher_.deliver(std::move(frame), samples_);
  };
  return ports;
}

void Simulator::run() {
  ros::AsyncSpinner inputs_and_diagnostics(1);
  inputs_and_diagnostics.start();
  MasterWatch master;
  ClockWatch clock;
  bool listening = false, known = true;
  while (ros::ok() && !loop_.ended() && known) {
    if (ready_ && !listening) {
      for (const auto& input : inputs_) input->subscribe(node_);
      listening = true;
    }
    std::this_thread::sleep_for(kWatchPeriod);
    known = master.check();
    clock.check();
  }
  loop_.stop();
  if (!known) throw Error("the ROS master is lost, or was restarted and does not know this node: start the node again");
}

}  // namespace viscera::nodes
