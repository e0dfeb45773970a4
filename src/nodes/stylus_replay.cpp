// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "nodes/stylus_replay.h"

#include <geometry_msgs/PoseStamped.h>
#include <ros/console.h>
#include <sensor_msgs/Joy.h>

#include <algorithm>
#include <chrono>
#include <thread>

#include "nodes/conversions.h"
#include "nodes/master_watch.h"
#include "nodes/scene_choice.h"

namespace viscera::nodes {
namespace {

using Clock = std::chrono::steady_clock;
constexpr uint32_t kButtonQueue = 16;
constexpr std::chrono::milliseconds kWaitPeriod{50};
constexpr std::chrono::milliseconds kFarewell{200};  ///< roscpp sends on another thread: let it finish

double since(Clock::time_point begin) {
  return std::chrono::duration<double>(Clock::now() - begin).count();
}

void requireMaster(MasterWatch& master) {
  if (!master.check()) throw Error("the ROS master is lost: start the node again");
}

void sendButton(const ros::Publisher& publisher, bool pressed, const ros::Time& stamp) {
  sensor_msgs::Joy message;
  message.header.stamp = stamp;
  message.buttons = {pressed ? 1 : 0};
  publisher.publish(message);
}

}  // namespace

ReplayOptions replayOptions(Parameters& parameters, const std::string& package_folder) {
  ReplayOptions options;
  const std::string strokes = parameters.text("strokes", "");
  const SceneChoice choice = SceneChoice::read(parameters, "");
  const std::string frame = parameters.text("frame", "");
  options.rate_hz = parameters.number("rate_hz", options.rate_hz, 1, 1000);
  options.delay_s = parameters.number("delay_s", options.delay_s, 0, 3600);
  options.loop = parameters.flag("loop", options.loop);
  parameters.refuseOthers();

  options.frame = choice.frame_prefix + options.frame;
  options.strokes = loadStrokes(namedFile("strokes", strokes, package_folder + "/config/strokes"));
  if (!choice.scene.empty()) {
    const Scene scene = choice.load(package_folder);
    options.frame = scene.environment.tissue_frame;
    if (options.strokes.anchored()) resolveAnchors(options.strokes, buildModel(scene));
  }
  if (options.strokes.anchored())
    throw ParameterError(
        "parameter ~scene: must be that of the simulator, since these strokes are anchored to its skin");
  if (!frame.empty()) options.frame = frame;
  return options;
}

StylusReplay::StylusReplay(const ReplayOptions& options) : options_(options) {
  for (const Stroke& stroke : options_.strokes.strokes) {
    const auto same = [&](const StylusConfig& config) { return config.name == stroke.stylus; };
    if (std::any_of(styluses_.begin(), styluses_.end(), same)) continue;
    styluses_.emplace_back().name = stroke.stylus;
    devices_.push_back({node_.advertise<geometry_msgs::PoseStamped>(stroke.stylus + "/measured_cp", 1),
                        node_.advertise<sensor_msgs::Joy>(stroke.stylus + "/button1", kButtonQueue),
                        node_.advertise<sensor_msgs::Joy>(stroke.stylus + "/button2", kButtonQueue),
                        {},
                        false});
  }
  if (styluses_.size() > layout::kMaxStyluses)
    throw StrokesError("the strokes name " + std::to_string(styluses_.size()) + " styluses; a simulator has at most " +
                       std::to_string(layout::kMaxStyluses));
}

bool StylusReplay::allHeard() const {
  return std::all_of(devices_.begin(), devices_.end(), [](const Device& device) {
    return device.pose.getNumSubscribers() > 0 && device.button1.getNumSubscribers() > 0 &&
           device.button2.getNumSubscribers() > 0;
  });
}

void StylusReplay::run() {
  MasterWatch master;
  while (ros::ok() && !allHeard()) {
    requireMaster(master);
    std::this_thread::sleep_for(kWaitPeriod);
  }
  ROS_INFO("playing %.1f s of strokes", options_.strokes.duration_s());
  play(-options_.delay_s, master);
  while (options_.loop && ros::ok()) play(0, master);
  std::this_thread::sleep_for(kFarewell);
}

void StylusReplay::play(double from_s, MasterWatch& master) {
  const Clock::time_point begun = Clock::now();
  const auto period = std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(1 / options_.rate_hz));
  const double end_s = options_.strokes.duration_s();
  Clock::time_point due = begun;
  for (double now_s = from_s; ros::ok() && now_s < end_s; now_s = from_s + since(begun)) {
    requireMaster(master);
    send(now_s);
    std::this_thread::sleep_until(due += period);
  }
  send(end_s);  // the last key may let a button go
}

void StylusReplay::send(double time_s) {
  const StylusSamples samples = options_.strokes.at(time_s, styluses_);
  for (size_t i = 0; i < devices_.size(); ++i)
    if (samples[i].valid) send(devices_[i], samples[i]);
}

void StylusReplay::send(Device& device, const StylusSample& sample) const {
  geometry_msgs::PoseStamped pose;
  pose.header.frame_id = options_.frame;
  pose.header.stamp = ros::Time::now();
  pose.pose = toMessage(sample.pose);
  device.pose.publish(pose);
  if (!device.begun || sample.button1 != device.last.button1)
    sendButton(device.button1, sample.button1, pose.header.stamp);
  if (!device.begun || sample.button2 != device.last.button2)
    sendButton(device.button2, sample.button2, pose.header.stamp);
  device.begun = true;
  device.last = sample;
}

}  // namespace viscera::nodes
