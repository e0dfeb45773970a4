// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "nodes/input/stylus_record.h"

#include <ros/console.h>
#include <ros/spinner.h>

#include <algorithm>
#include <chrono>
#include <thread>

#include "math/out_file.h"
#include "nodes/ros/conversions.h"

namespace viscera::nodes {
namespace {

constexpr std::chrono::milliseconds kWatchPeriod{20};
constexpr uint32_t kStylusRecordQueue = 0;  ///< queue without a limit: no tick may be dropped
constexpr double kMost_s = 3600;            ///< longest duration of a strokes file [s]

}  // namespace

Recording::Outcome Recording::end(const std::string& why) {
  if (fault_.empty()) fault_ = why;
  return Outcome::kEnded;
}

Stroke& Recording::strokeOf(const std::string& stylus) {
  const auto same = [&](const Stroke& stroke) { return stroke.stylus == stylus; };
  const auto found = std::find_if(strokes_.strokes.begin(), strokes_.strokes.end(), same);
  if (found != strokes_.strokes.end()) return *found;
  strokes_.strokes.emplace_back().stylus = stylus;
  return strokes_.strokes.back();
}

Recording::Outcome Recording::add(const Samples& message) {
  if (!fault_.empty()) return Outcome::kEnded;
  if (message.tick != 1 && strokes_.ticks == 0) return Outcome::kWaiting;
  if (!message.besides.empty())
    return end("strokes cannot contain everything that moves the tissue: " + message.besides);
  const bool begins = message.tick == 1 && strokes_.ticks > 0;
  if (message.tick == 1) strokes_ = {};
  if (message.tick != strokes_.ticks + 1)
    return end("ticks " + std::to_string(strokes_.ticks + 1) + " to " + std::to_string(message.tick - 1) +
               " were lost: the machine or the network is too slow for recording and simulation");
  if (static_cast<double>(message.tick) > kMost_s * message.tick_hz)
    return end("one hour is recorded, which is the limit of a strokes file");
  strokes_.tick_hz = message.tick_hz;
  strokes_.recorded.scene = message.scene;
  strokes_.recorded.overrides = message.overrides;
  strokes_.ticks = message.tick;
  if (message.input_reset) strokes_.input_reset.push_back(message.tick);
  for (const StylusState& state : message.styluses)
    strokeOf(state.stylus)
        .samples.push_back({message.tick, fromMessage(state.pose), state.button1 != 0, state.button2 != 0,
                            state.has_jaw ? state.jaw_rad : kNoJaw});
  return begins ? Outcome::kAnew : Outcome::kTaken;
}

RecordOptions recordOptions(Parameters& parameters) {
  RecordOptions options;
  options.file = parameters.text("file", "");
  options.reset = parameters.flag("reset", options.reset);
  options.seconds = parameters.number("seconds", options.seconds, 0, kMost_s);
  parameters.refuseOthers();
  if (options.file.empty()) throw ParameterError("parameter ~file: must name the strokes file to write");
  // Checks now that the file can be written, not after the recording.
  try {
    const OutFile draft(options.file, FileKind::kStrokes);
  } catch (const Error& error) {
    throw ParameterError(std::string("parameter ~file: ") + error.what());
  }
  return options;
}

StylusRecord::StylusRecord(const RecordOptions& options)
    : options_(options),
      private_("~"),
      reset_(node_.serviceClient<std_srvs::Trigger>("reset")),
      step_(node_.serviceClient<Step>("step")),
      save_(private_.advertiseService("save", &StylusRecord::save, this)),
      samples_(node_.subscribe("samples", kStylusRecordQueue, &StylusRecord::onSamples, this,
                               ros::TransportHints().tcpNoDelay())) {}

void StylusRecord::onSamples(const Samples& message) {
  const std::lock_guard<std::mutex> lock(mutex_);
  const bool ended = !recording_.fault().empty();
  switch (recording_.add(message)) {
    case Recording::Outcome::kTaken:
      if (message.tick == 1) ROS_INFO("recording since tick 1");
      break;
    case Recording::Outcome::kAnew:
      ROS_WARN("the session was reset; the recording restarts");
      break;
    case Recording::Outcome::kWaiting:
      // The first tick came before the subscription was established: reset again.
      needs_reset_ = needs_reset_ || (!reset_at_.isZero() && message.header.stamp > reset_at_);
      break;
    case Recording::Outcome::kEnded:
      if (!ended) ROS_ERROR("the recording has ended: %s", recording_.fault().c_str());
      break;
  }
}

/// Returns the state hash of a simulation that is paused at the last recorded tick; empty while it runs.
std::string StylusRecord::stateHash(uint64_t tick) {
  Step call;
  const bool received = ros::ok() && step_.call(call) && call.response.success && call.response.tick == tick;
  return received ? call.response.state_hash : "";
}

std::string StylusRecord::write() {
  Strokes strokes;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    strokes = recording_.strokes();
  }
  if (strokes.ticks == 0) throw StrokesError("no tick was recorded; " + options_.file + " is not written");
  if (strokes.strokes.empty()) throw StrokesError("no stylus was tracked; " + options_.file + " is not written");
  strokes.recorded.state_hash = stateHash(strokes.ticks);
  try {
    writeFile(options_.file, FileKind::kStrokes, strokesYaml(strokes));
  } catch (const Error& error) {
    throw StrokesError(error.what());
  }
  return std::to_string(strokes.ticks) + " ticks are in " + options_.file;
}

bool StylusRecord::save(std_srvs::Trigger::Request&, std_srvs::Trigger::Response& response) {
  try {
    response.message = write();
    response.success = true;
  } catch (const StrokesError& error) {
    response.success = false;
    response.message = error.what();
  }
  return true;
}

void StylusRecord::resetSimulation() {
  std_srvs::Trigger call;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    needs_reset_ = false;
    reset_at_ = ros::Time();
  }
  const bool good = reset_.call(call) && call.response.success;
  const std::lock_guard<std::mutex> lock(mutex_);
  reset_at_ = ros::Time::now();
  if (!good && ros::ok())
    ROS_WARN("%s: the reset failed (%s)", reset_.getService().c_str(), call.response.message.c_str());
}

bool StylusRecord::isOver() {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (!recording_.fault().empty()) return true;
  const Strokes& strokes = recording_.strokes();
  return options_.seconds > 0 && strokes.ticks > 0 &&
         static_cast<double>(strokes.ticks) >= options_.seconds * strokes.tick_hz;
}

void StylusRecord::run() {
  ros::AsyncSpinner spinner(2);
  spinner.start();
  bool asked = !options_.reset;
  if (asked) ROS_INFO("the recording starts with the next `reset` of the simulator");
  while (ros::ok() && !isOver()) {
    master_.require();
    bool again = false;
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      again = needs_reset_;
    }
    if ((!asked || again) && samples_.getNumPublishers() > 0) {
      asked = true;
      resetSimulation();
    }
    std::this_thread::sleep_for(kWatchPeriod);
  }
  const std::string done = write();
  std::string fault;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    fault = recording_.fault();
  }
  if (!fault.empty()) throw StrokesError(fault + "; " + done);
  ROS_INFO("%s", done.c_str());
}

}  // namespace viscera::nodes
