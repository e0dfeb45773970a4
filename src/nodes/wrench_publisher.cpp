// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "nodes/wrench_publisher.h"

#include <geometry_msgs/WrenchStamped.h>
#include <std_msgs/Bool.h>

#include "nodes/conversions.h"
#include "nodes/thread_name.h"

namespace viscera::nodes {
namespace {

using Clock = std::chrono::steady_clock;

/// Longer than a release takes, WrenchSchedule::kRelease_s, even on a busy machine; an end waits no longer.
constexpr std::chrono::milliseconds kReleaseLimit{40};
/// roscpp writes to sockets on a thread of its own and tells nobody when it has: it has by then.
constexpr std::chrono::milliseconds kFlush{10};

}  // namespace

WrenchPublisher::WrenchPublisher(ros::NodeHandle& node, const std::vector<const StylusMailbox*>& mailboxes,
                                 double stall_s)
    : mailboxes_(mailboxes),
      schedule_(
          [&] {
            std::vector<ForceLimits> limits;
            for (const StylusMailbox* mailbox : mailboxes) limits.push_back(ForceLimits::of(mailbox->config()));
            return limits;
          }(),
          stall_s),
      latencies_(mailboxes.size()) {
  for (const StylusMailbox* mailbox : mailboxes_) {
    const std::string body = mailbox->config().name + "/body/";
    forces_.push_back(node.advertise<geometry_msgs::WrenchStamped>(body + "servo_cf", 1));
    // A CRTK device takes a body wrench in its tip's frame unless told that it is in the frame of its poses.
    absolutes_.push_back(node.advertise<std_msgs::Bool>(body + "set_cf_orientation_absolute", 1, true));
    std_msgs::Bool absolute;
    absolute.data = true;
    absolutes_.back().publish(absolute);
  }
  thread_ = std::thread([this] { main(); });
}

WrenchPublisher::~WrenchPublisher() {
  release();
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    stop_ = true;
  }
  changed_.notify_one();
  thread_.join();
}

void WrenchPublisher::put(const Hands& hands) {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    Wrenches wanted;
    for (size_t s = 0; s < hands.size(); ++s) {
      wanted[s] = hands[s].reaction;
      poses_received_[s] = hands[s].pose_received;
    }
    schedule_.put(wanted, Clock::now());
    put_ = true;
  }
  changed_.notify_one();
}

void WrenchPublisher::rest() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    schedule_.rest(Clock::now());
    poses_received_ = {};
    put_ = true;
  }
  changed_.notify_one();
}

void WrenchPublisher::release() {
  std::unique_lock<std::mutex> lock(mutex_);
  if (schedule_.released()) return;
  schedule_.release(Clock::now());
  put_ = true;
  changed_.notify_one();
  if (sent_.wait_for(lock, kReleaseLimit, [this] { return schedule_.released(); })) std::this_thread::sleep_for(kFlush);
}

void WrenchPublisher::main() {
  nameThread("wrenches");
  std::unique_lock<std::mutex> lock(mutex_);
  while (!stop_) {
    changed_.wait_until(lock, schedule_.due(), [this] { return put_ || stop_; });
    if (stop_) return;
    put_ = false;
    const Wrenches wrenches = schedule_.next(Clock::now());
    stalls_ = schedule_.stalls();
    stalled_ = schedule_.stalled();
    lock.unlock();
    send(wrenches);
    lock.lock();
    const Clock::time_point now = Clock::now();
    for (size_t s = 0; s < latencies_.size(); ++s) latencies_[s].add(poses_received_[s], now);
    if (schedule_.released()) sent_.notify_all();
  }
}

void WrenchPublisher::send(const Wrenches& wrenches) {
  const ros::Time stamp = ros::Time::now();
  for (size_t s = 0; s < forces_.size(); ++s) {
    if (forces_[s].getNumSubscribers() == 0) continue;
    const DeviceFrame frame = mailboxes_[s]->deviceFrame();
    forces_[s].publish(toWrench(wrenches[s], frame.from_tissue, frame.name, stamp));
  }
}

std::vector<LatencyMeter::Reading> WrenchPublisher::takeLatencies() {
  const std::lock_guard<std::mutex> lock(mutex_);
  std::vector<LatencyMeter::Reading> out;
  for (LatencyMeter& meter : latencies_) out.push_back(meter.take());
  return out;
}

}  // namespace viscera::nodes
