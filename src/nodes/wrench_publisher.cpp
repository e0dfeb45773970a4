// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "nodes/wrench_publisher.h"

#include <ros/console.h>
#include <std_msgs/Float64.h>

#include <algorithm>
#include <utility>

#include "nodes/impedance.h"
#include "nodes/thread_name.h"
#include "nodes/thread_schedule.h"

namespace viscera::nodes {
namespace {

using Clock = std::chrono::steady_clock;

/// Longer than a release takes, WrenchSchedule::kRelease_s, even on a busy machine; an end waits no longer.
constexpr std::chrono::milliseconds kReleaseLimit{40};
/// roscpp writes to sockets on a thread of its own and tells nobody when it has: it has by then.
constexpr std::chrono::milliseconds kFlush{10};

}  // namespace

WrenchPublisher::WrenchPublisher(ros::NodeHandle& node, const std::vector<const StylusMailbox*>& mailboxes,
                                 double stall_s, const Scene& scene, const HapticOptions& options)
    : mailboxes_(mailboxes),
      schedule_(
          [&] {
            std::vector<ForceLimits> limits;
            for (const StylusMailbox* mailbox : mailboxes) limits.push_back(ForceLimits::of(mailbox->config()));
            return limits;
          }(),
          stall_s),
      haptics_(options, scene, mailboxes),
      priority_(options.priority),
      tissue_frame_(scene.environment.tissue_frame),
      latencies_(mailboxes.size()) {
  for (const StylusMailbox* mailbox : mailboxes_) sinks_.emplace_back(node, mailbox->device());
  for (const StylusMailbox* mailbox : mailboxes_) {
    if (!haptics_.on()) break;
    energies_.push_back(node.advertise<std_msgs::Float64>(mailbox->config().name + "/energy", 1));
    impedances_.push_back(node.advertise<foreign::CartesianImpedance>(mailbox->config().name + "/servo_ci", 1));
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

void WrenchPublisher::setLimits(size_t stylus, const ForceLimits& limits) {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    schedule_.setLimits(stylus, limits);
  }
  changed_.notify_one();
}

void WrenchPublisher::put(const Hands& hands) {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    Wrenches wanted;
    const Clock::time_point now = Clock::now();
    for (size_t s = 0; s < hands.size(); ++s) {
      wanted[s] = hands[s].reaction;
      if (!answering_) poses_received_[s] = hands[s].pose_received;
      if (s < mailboxes_.size()) haptics_.put(s, hands[s].contact, hands[s].tracked, now);
    }
    schedule_.put(wanted, now);
    ticked_ = true;
    if (answering_) return;  // the next period is soon enough
    put_ = true;
  }
  changed_.notify_one();
}

void WrenchPublisher::rest() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    schedule_.rest(Clock::now());
    haptics_.rest(Clock::now());
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

/// Late answers are worse than late ticks: the thread asks to go first.
void WrenchPublisher::schedule() {
  if (!haptics_.on()) return;
  const std::string how = goFirst(priority_);
  const std::lock_guard<std::mutex> lock(mutex_);
  scheduling_ = how;
}

bool WrenchPublisher::isHeard() const {
  return std::any_of(sinks_.begin(), sinks_.end(), [](const ForceSink& sink) { return sink.hasSubscribers(); });
}

/// When the next message is due. @param period_due  of the loop between ticks
SteadyTime WrenchPublisher::due(SteadyTime period_due) const {
  return answering_ ? std::min(period_due, std::max(schedule_.due(), Clock::now())) : schedule_.due();
}

/// What the local models want at the newest poses.
void WrenchPublisher::answer(SteadyTime now) {
  schedule_.follow(haptics_.answers(now, poses_received_));
}

void WrenchPublisher::main() {
  nameThread("wrenches");
  schedule();
  const auto period = std::chrono::duration_cast<Clock::duration>(
      std::chrono::duration<double>(haptics_.on() ? haptics_.period_s() : 1));
  Clock::time_point period_due = Clock::now();
  std::unique_lock<std::mutex> lock(mutex_);
  while (!stop_) {
    changed_.wait_until(lock, due(period_due), [this] { return put_ || stop_; });
    if (stop_) return;
    put_ = false;
    const Clock::time_point now = Clock::now();
    if (answering_) {
      answer(now);
      period_due = std::max(period_due + period, now);
    }
    const Wrenches wrenches = schedule_.next(now);
    if (answering_) haptics_.sent(wrenches);
    stalls_ = schedule_.stalls();
    stalled_ = schedule_.stalled();
    const bool ticked = std::exchange(ticked_, false), live = schedule_.live();
    lock.unlock();
    send(wrenches);
    if (ticked) sendEnergies();
    if (ticked || !live) sendImpedances(live);
    const bool heard = haptics_.on() && isHeard();
    lock.lock();
    const Clock::time_point sent = Clock::now();
    for (size_t s = 0; s < latencies_.size(); ++s) latencies_[s].add(poses_received_[s], sent);
    if (schedule_.released()) sent_.notify_all();
    const bool answering = heard && schedule_.live();
    if (answering && !answering_) period_due = sent + period;
    answering_ = answering;
  }
}

void WrenchPublisher::send(const Wrenches& wrenches) {
  const ros::Time stamp = ros::Time::now();
  for (size_t s = 0; s < sinks_.size(); ++s) {
    if (sinks_[s].hasSubscribers()) sinks_[s].send(wrenches[s], mailboxes_[s]->deviceFrame(), stamp);
  }
}

void WrenchPublisher::sendEnergies() {
  const std::vector<HapticLoop::Felt> all = felt();
  for (size_t s = 0; s < energies_.size(); ++s) {
    if (energies_[s].getNumSubscribers() == 0) continue;
    std_msgs::Float64 energy;
    energy.data = all[s].energy_j;
    energies_[s].publish(energy);
  }
}

/// @param live  ticks come in time; else nothing is to be felt
void WrenchPublisher::sendImpedances(bool live) {
  const ros::Time stamp = ros::Time::now();
  for (size_t s = 0; s < impedances_.size(); ++s) {
    if (impedances_[s].getNumSubscribers() == 0) continue;
    foreign::CartesianImpedance message = noImpedance(tissue_frame_, stamp);
    if (live) {
      const std::lock_guard<std::mutex> lock(mutex_);
      message = toImpedance(haptics_.servo(s), tissue_frame_, stamp);
    }
    impedances_[s].publish(message);
  }
}

std::vector<HapticLoop::Felt> WrenchPublisher::felt() {
  const std::lock_guard<std::mutex> lock(mutex_);
  std::vector<HapticLoop::Felt> out;
  for (size_t s = 0; s < mailboxes_.size(); ++s) out.push_back(haptics_.felt(s));
  return out;
}

std::string WrenchPublisher::scheduling() {
  const std::lock_guard<std::mutex> lock(mutex_);
  return scheduling_;
}

std::vector<LatencyMeter::Reading> WrenchPublisher::takeLatencies() {
  const std::lock_guard<std::mutex> lock(mutex_);
  std::vector<LatencyMeter::Reading> out;
  for (LatencyMeter& meter : latencies_) out.push_back(meter.take());
  return out;
}

}  // namespace viscera::nodes
