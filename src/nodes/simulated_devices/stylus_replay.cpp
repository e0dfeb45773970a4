// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "nodes/simulated_devices/stylus_replay.h"

#include <ros/console.h>
#include <ros/spinner.h>
#include <std_srvs/Trigger.h>

#include <algorithm>
#include <chrono>
#include <thread>

#include "nodes/ros/scene_choice.h"
#include "viscera/model/scene/scene.h"

namespace viscera::nodes {
namespace {

using Clock = std::chrono::steady_clock;
constexpr std::chrono::milliseconds kWaitPeriod{50};
constexpr std::chrono::milliseconds kFarewell{200};  ///< roscpp sends on another thread: gives it time to finish

}  // namespace

ReplayOptions replayOptions(Parameters& parameters, const std::string& package_folder) {
  ReplayOptions options;
  const std::string strokes = parameters.text("strokes", "");
  const SceneChoice choice = SceneChoice::read(parameters, "", package_folder);
  const std::string frame = parameters.text("frame", "");
  options.rate_hz = parameters.number("rate_hz", options.rate_hz, 1, 1000);
  options.delay_s = parameters.number("delay_s", options.delay_s, 0, 3600);
  options.loop = parameters.flag("loop", options.loop);
  options.wait_for_viewer = parameters.flag("wait_for_viewer", options.wait_for_viewer);
  options.reset_between_rounds = parameters.flag("reset_between_rounds", options.reset_between_rounds);
  parameters.refuseOthers();

  options.frame = choice.frame_prefix + options.frame;
  options.strokes = loadStrokes(namedFile("strokes", strokes, package_folder + "/config/strokes"));
  if (!choice.scene.empty()) {
    const Scene scene = choice.load(package_folder);
    options.frame = scene.environment.tissue_frame;
    if (options.strokes.anchored()) {
      for (const std::string& note : resolveAnchors(options.strokes, buildModel(scene), scene.fit))
        ROS_WARN_STREAM("strokes: " << note);
    }
  }
  if (options.strokes.anchored())
    throw ParameterError(
        "parameter ~scene: must be the scene of the simulator, because these strokes are anchored to its skin");
  if (!frame.empty()) options.frame = frame;
  return options;
}

ReplayOptions simDeviceOptions(Parameters& parameters, const std::string& package_folder) {
  const SimulatedDeviceConfig device = simulatedDevice(parameters);
  const bool has_rate = parameters.has("rate_hz");
  const int priority = static_cast<int>(parameters.number("priority", ReplayOptions{}.priority, 0, 99));
  ReplayOptions options = replayOptions(parameters, package_folder);
  options.device = device;
  options.priority = priority;
  if (!has_rate) options.rate_hz = 1 / device.period_s;
  return options;
}

StylusReplay::StylusReplay(const ReplayOptions& options)
    : options_(options), reset_(node_.serviceClient<std_srvs::Trigger>("reset")), simulation_(node_) {
  for (const Stroke& stroke : options_.strokes.strokes) {
    const auto same = [&](const StylusConfig& config) { return config.name == stroke.stylus; };
    if (std::any_of(styluses_.begin(), styluses_.end(), same)) continue;
    styluses_.emplace_back().name = stroke.stylus;
    devices_.emplace_back(node_, stroke.stylus);
    if (options_.device) held_.push_back(std::make_unique<HeldDevice>(node_, stroke.stylus, *options_.device));
  }
  if (styluses_.size() > layout::kMaxStyluses)
    throw StrokesError("the strokes name " + std::to_string(styluses_.size()) + " styluses; a simulator has at most " +
                       std::to_string(layout::kMaxStyluses));
}

bool StylusReplay::allReceived() const {
  return std::all_of(devices_.begin(), devices_.end(),
                     [](const DevicePublisher& device) { return device.isReceived(); });
}

void StylusReplay::check() {
  master_.require();
  clock_.check();
}

void StylusReplay::waitForOthers() {
  const auto wait = [this](const auto& condition) {
    while (ros::ok() && !condition()) {
      check();
      std::this_thread::sleep_for(kWaitPeriod);
    }
  };
  wait([this] { return allReceived() && !ros::Time::now().isZero(); });  // a stamp of zero marks poses as invalid
  if (!options_.wait_for_viewer || simulation_.isViewed()) return;
  ROS_INFO("waiting for a viewer: a subscriber of surface, surface_marker, scene_markers or an image");
  wait([this] { return simulation_.isViewed(); });
}

void StylusReplay::run() {
  ros::AsyncSpinner ticks(1);
  ticks.start();
  waitForOthers();
  ROS_INFO("playing %.1f s of strokes", options_.strokes.duration_s());
  play(-options_.delay_s);
  while (options_.loop && ros::ok()) {
    if (options_.reset_between_rounds) resetSimulation();
    play(0);
  }
  std::this_thread::sleep_for(kFarewell);
  for (const auto& device : held_) ROS_INFO("%s", device->summary().c_str());
}

void StylusReplay::resetSimulation() {
  std_srvs::Trigger call;
  if (reset_.call(call) && call.response.success) return;
  if (ros::ok())
    ROS_WARN("%s: the reset between two rounds failed (%s)", reset_.getService().c_str(),
             call.response.message.c_str());
}

void StylusReplay::play(double from_s) {
  const auto period = std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(1 / options_.rate_hz));
  const double end_s = options_.strokes.duration_s();
  Clock::time_point due = Clock::now();
  simulation_.take();
  for (double now_s = from_s; ros::ok() && now_s < end_s; now_s += simulation_.take()) {
    check();
    send(now_s);
    due = std::max(due + period, Clock::now() - kWaitPeriod);  // a long delay is not made up for
    std::this_thread::sleep_until(due);
  }
  send(end_s);  // the last key may release a button
}

void StylusReplay::send(double time_s) {
  const StylusSamples samples = options_.strokes.at(time_s, styluses_);
  for (size_t i = 0; i < devices_.size(); ++i)
    if (samples[i].valid) send(i, samples[i]);
}

void StylusReplay::send(size_t stylus, StylusSample sample) {
  if (!held_.empty()) sample.pose = held_[stylus]->follow(sample.pose);
  devices_[stylus].send(sample, options_.frame, ros::Time::now());
}

}  // namespace viscera::nodes
