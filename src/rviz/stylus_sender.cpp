// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "rviz/stylus_sender.h"

#include <geometry_msgs/PoseStamped.h>
#include <ros/exception.h>
#include <ros/master.h>
#include <ros/node_handle.h>
#include <sensor_msgs/Joy.h>

#include <optional>

namespace viscera::rviz_plugin {
namespace {

using Clock = std::chrono::steady_clock;
constexpr std::chrono::milliseconds kPeriod{10};
constexpr std::chrono::seconds kSilence{1};  // time without a call, when the window does not draw
constexpr double kTurn_rad_per_s = 3;

geometry_msgs::PoseStamped message(const Pose& pose, const std::string& frame) {
  geometry_msgs::PoseStamped out;
  out.header.stamp = ros::Time::now();
  out.header.frame_id = frame;
  out.pose.position.x = pose.position_m.x();
  out.pose.position.y = pose.position_m.y();
  out.pose.position.z = pose.position_m.z();
  out.pose.orientation.x = pose.orientation.x();
  out.pose.orientation.y = pose.orientation.y();
  out.pose.orientation.z = pose.orientation.z();
  out.pose.orientation.w = pose.orientation.w();
  return out;
}

}  // namespace

/// The topics of one stylus, and what was last sent on them.
struct StylusSender::Topics {
  explicit Topics(const std::string& prefix) : name(prefix) {
    ros::NodeHandle node;
    pose = node.advertise<geometry_msgs::PoseStamped>(prefix + "measured_cp", 1);
    for (size_t b = 0; b < buttons.size(); ++b)
      buttons[b] = node.advertise<sensor_msgs::Joy>(prefix + "button" + std::to_string(b + 1), 10);
  }
  void press(const std::array<bool, 2>& wanted) {
    for (size_t b = 0; b < buttons.size(); ++b) {
      if (down[b] == wanted[b]) continue;
      down[b] = wanted[b];
      sensor_msgs::Joy joy;
      joy.header.stamp = ros::Time::now();
      joy.buttons = {down[b] ? 1 : 0};
      buttons[b].publish(joy);
    }
  }
  const std::string name;
  ros::Publisher pose;
  std::array<ros::Publisher, 2> buttons;
  std::array<bool, 2> down{};
  std::optional<Pose> tip;  ///< last pose that was sent; empty: the stylus appears again
};

StylusSender::StylusSender() : thread_([this] { main(); }) {}

StylusSender::~StylusSender() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    ending_ = true;
  }
  changed_.notify_all();
  thread_.join();
}

void StylusSender::request(const WantedStylus& wanted) {
  const std::lock_guard<std::mutex> lock(mutex_);
  wanted_ = wanted;
  sent_at_ = Clock::now();
}

void StylusSender::rest() {
  request({});
}

void StylusSender::main() {
  std::unique_ptr<Topics> topics;
  std::unique_lock<std::mutex> lock(mutex_);
  for (Clock::time_point next = Clock::now(); !changed_.wait_until(lock, next, [this] { return ending_; });
       next = std::max(next + kPeriod, Clock::now())) {
    const WantedStylus wanted = Clock::now() - sent_at_ < kSilence ? wanted_ : WantedStylus();
    lock.unlock();
    if (topics && topics->name != wanted.topics) {
      topics->press({});
      topics->tip.reset();
      if (!wanted.topics.empty()) topics.reset();
    }
    try {
      if (!topics && !wanted.topics.empty() && ros::master::check()) topics = std::make_unique<Topics>(wanted.topics);
    } catch (const ros::Exception&) {  // not a valid name of a topic, which the tool reports
    }
    if (topics && topics->name == wanted.topics) {
      const SteeredSpeed speed{wanted.speed_m_per_s, kTurn_rad_per_s};
      topics->tip = topics->tip
                        ? approach(*topics->tip, wanted.tip, speed, std::chrono::duration<double>(kPeriod).count())
                        : wanted.tip;
      topics->pose.publish(message(*topics->tip, wanted.frame));
      topics->press(wanted.buttons);
    }
    lock.lock();
  }
  lock.unlock();
  if (topics) topics->press({});
}

}  // namespace viscera::rviz_plugin
