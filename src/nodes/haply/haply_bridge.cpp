// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "nodes/haply/haply_bridge.h"

#include <geometry_msgs/PoseStamped.h>
#include <geometry_msgs/TwistStamped.h>
#include <ros/console.h>
#include <sensor_msgs/Joy.h>

#include <algorithm>
#include <thread>
#include <utility>

#include "nodes/ros/conversions.h"
#include "nodes/ros/master_watch.h"

namespace viscera::nodes {
namespace {

using HaplyLevel = diagnostic_msgs::DiagnosticStatus;

constexpr uint32_t kHaplyButtonQueue = 16;
constexpr std::chrono::milliseconds kHaplyPoll{20};      // time until a lost master is detected
constexpr std::chrono::milliseconds kReleaseLimit{150};  // of the wait for zeros to be sent, within EndWatch::kLimit
constexpr std::chrono::milliseconds kReleasePoll{1};
constexpr uint64_t kZerosAtEnd = 2;  // one may have been computed before the release
constexpr std::chrono::seconds kReportEvery{1}, kDroppedEvery{10};
constexpr size_t kMostNotes = 100;
constexpr std::chrono::seconds kPosesLimit{1};  // without a pose until the diagnostics warn

/// Orientation without a grip: one that points down, as an upright pen does.
const Quaterniond kNoGrip(Eigen::AngleAxisd(-M_PI / 2, Vector3d::UnitX()));

}  // namespace

HaplyOptions haplyOptions(Parameters& parameters) {
  HaplyOptions options;
  options.name = parameters.text("name", options.name);
  options.device = parameters.identifier("device", options.device);
  options.grip = parameters.identifier("grip", options.grip);
  options.service.host = parameters.text("host", options.service.host);
  options.service.port = static_cast<uint16_t>(parameters.number("port", options.service.port, 1, 65535));
  options.service.period = std::chrono::duration<double>(1 / parameters.number("rate_hz", 1000, 50, 4000));
  options.timeout_s = parameters.number("timeout_s", options.timeout_s, 0.005, 1);
  options.max_force_n = parameters.number("max_force_n", options.max_force_n, 0, 20);
  parameters.refuseOthers();
  for (const auto& [key, value] : {std::pair("name", options.name), {"device", options.device}, {"grip", options.grip}})
    if (value.empty()) throw ParameterError(std::string("parameter ~") + key + ": must not be empty");
  return options;
}

HaplyBridge::HaplyBridge(const HaplyOptions& options, EndWatch& end)
    : options_(options),
      end_(end),
      poses_(node_.advertise<geometry_msgs::PoseStamped>(options.name + "/measured_cp", 1)),
      velocities_(node_.advertise<geometry_msgs::TwistStamped>(options.name + "/measured_cv", 1)),
      buttons_(node_.advertise<sensor_msgs::Joy>(options.name + "/buttons", kHaplyButtonQueue, true)),
      act_(
          end, [this] { release(); }, [this] { release(); }, [this] { released_ = false; }),
      spinner_(1) {
  const auto hints = ros::TransportHints().tcpNoDelay();
  const std::string body = options.name + "/body/";
  wrench_ = node_.subscribe(body + "servo_cf", 1, &HaplyBridge::onWrench, this, hints);
  absolute_ = node_.subscribe<std_msgs::Bool>(body + "set_cf_orientation_absolute", 1,
                                              [this](const std_msgs::BoolConstPtr& message) {
                                                const std::lock_guard<std::mutex> lock(mutex_);
                                                is_absolute_ = message->data;
                                              });
  updater_.setHardwareID("none");
  updater_.add(options.name, this, &HaplyBridge::report);
  socket_ = std::make_unique<InverseSocket>(
      options.service,
      InverseSocket::Callbacks{[this](const std::string& message, bool first) { return take(message, first); },
                               [this] { return command(); }, [this](const std::string& why) { lose(why); }});
  spinner_.start();
}

HaplyBridge::~HaplyBridge() {
  spinner_.stop();
  release();
  socket_.reset();
}

void HaplyBridge::run() {
  MasterWatch master;
  while (!end_.waitFor(kHaplyPoll)) {
    log();
    master.require();
    if (Clock::now() < report_due_) continue;
    report_due_ = Clock::now() + kReportEvery;
    updater_.force_update();
  }
}

std::string HaplyBridge::take(const std::string& message, bool first) try {
  if (first) choose(message);
  InverseState state = readState(message, devices_);
  if (!state.grip_came.empty()) {
    // Without a new connection, which would leave the last force on the motors meanwhile.
    devices_.grip = state.grip_came;
    tell("a grip has come: ");
    state = readState(message, devices_);
  }
  ++states_;
  publish(state);
  return {};
} catch (const InverseError& error) {
  if (devices_.device.empty()) return error.what();
  const std::lock_guard<std::mutex> lock(mutex_);
  ++dropped_;
  last_dropped_ = error.what();
  return {};
}

void HaplyBridge::choose(const std::string& inventory) {
  devices_ = {};
  devices_ = chooseDevices(inventory, options_.device, options_.grip);
  first_command_ = true;
  ++connections_;
  tell("connected: ");
}

/// Notes the devices of the connection.
void HaplyBridge::tell(const std::string& event) {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (!std::exchange(connected_, true)) posed_ = Clock::now();
  state_ = devices_.description + (devices_.grip.empty() ? ", without a grip" : ", grip " + devices_.grip);
  if (notes_.size() < kMostNotes) notes_.push_back({event + state_, false});
}

void HaplyBridge::publish(const InverseState& state) {
  const ros::Time now = ros::Time::now();
  const std::string frame = options_.name + "_base";
  geometry_msgs::PoseStamped pose;
  pose.header.stamp = now;
  pose.header.frame_id = frame;
  const Quaterniond grip = state.grip.value_or(kNoGrip);
  pose.pose = toMessage(Pose{state.position_m, grip});
  poses_.publish(pose);
  if (velocities_.getNumSubscribers() > 0) {
    geometry_msgs::TwistStamped velocity;
    velocity.header = pose.header;
    velocity.twist.linear = toVector(state.velocity_m_per_s);
    velocities_.publish(velocity);
  }
  if (first_command_ || state.buttons != sent_buttons_) {
    sensor_msgs::Joy message;
    message.header.stamp = now;
    message.buttons.assign(state.buttons.begin(), state.buttons.end());
    buttons_.publish(message);
    sent_buttons_ = state.buttons;
  }
  const std::lock_guard<std::mutex> lock(mutex_);
  grip_ = grip;
  calibrated_ = state.calibrated;
  posed_ = Clock::now();
}

std::string HaplyBridge::command() {
  Vector3d force_n = Vector3d::Zero();
  if (!released_) {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (std::chrono::duration<double>(Clock::now() - heard_).count() < options_.timeout_s)
      force_n = is_absolute_ ? force_n_ : grip_ * force_n_;
  }
  const double size_n = force_n.norm();
  if (size_n > options_.max_force_n) force_n *= options_.max_force_n / size_n;
  if (force_n.isZero(0)) ++zeros_;
  return forceCommand(devices_, force_n, std::exchange(first_command_, false));
}

void HaplyBridge::lose(const std::string& why) {
  const std::lock_guard<std::mutex> lock(mutex_);
  connected_ = false;
  if (std::exchange(state_, why) == why || notes_.size() >= kMostNotes) return;
  notes_.push_back({"no connection to the Haply Inverse Service at " + options_.service.host + " port " +
                        std::to_string(options_.service.port) + " (" + why + "); tries again every second",
                    true});
}

void HaplyBridge::onWrench(const geometry_msgs::WrenchStamped& message) {
  const geometry_msgs::Vector3& force = message.wrench.force;
  const Vector3d force_n(force.x, force.y, force.z);
  const std::lock_guard<std::mutex> lock(mutex_);
  if (!force_n.allFinite()) {
    ++dropped_;
    last_dropped_ = "a wrench is not finite";
    return;
  }
  force_n_ = force_n;
  heard_ = Clock::now();
}

/// Takes the force from the device, and waits until the service has the message.
void HaplyBridge::release() {
  released_ = true;
  const uint64_t before = zeros_;
  const Clock::time_point limit = Clock::now() + kReleaseLimit;
  while (zeros_ < before + kZerosAtEnd && Clock::now() < limit) std::this_thread::sleep_for(kReleasePoll);
}

/// Logs what the socket's thread has noted, which does not wait for the log.
void HaplyBridge::log() {
  std::vector<Note> notes;
  std::string dropped;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    notes.swap(notes_);
    if (dropped_ != logged_dropped_ && Clock::now() >= log_due_) {
      dropped = std::to_string(dropped_) + " messages were dropped so far; the last: " + last_dropped_;
      logged_dropped_ = dropped_;
      log_due_ = Clock::now() + kDroppedEvery;
    }
  }
  for (const Note& one : notes) {
    if (one.is_warning)
      ROS_WARN("%s", one.text.c_str());
    else
      ROS_INFO("%s", one.text.c_str());
  }
  if (!dropped.empty()) ROS_WARN("%s", dropped.c_str());
}

void HaplyBridge::report(diagnostic_updater::DiagnosticStatusWrapper& status) {
  const Clock::time_point now = Clock::now();
  const double span_s = std::chrono::duration<double>(now - std::exchange(reported_, now)).count();
  const uint64_t states = states_;
  const std::lock_guard<std::mutex> lock(mutex_);
  status.summary(connected_ ? HaplyLevel::OK : HaplyLevel::ERROR, connected_ ? state_ : "no connection: " + state_);
  if (connected_ && !calibrated_) status.summary(HaplyLevel::WARN, "not calibrated; put the grip on its inkwell");
  if (connected_ && now - posed_ > kPosesLimit)
    status.summary(HaplyLevel::WARN, "no pose in the last second" +
                                         (last_dropped_.empty() ? "" : "; the last message dropped: " + last_dropped_));
  status.add("states", states);
  status.add("states_per_s", static_cast<double>(states - std::exchange(reported_states_, states)) / span_s);
  status.add("dropped", dropped_.load());
  status.add("connections", connections_.load());
}

}  // namespace viscera::nodes
