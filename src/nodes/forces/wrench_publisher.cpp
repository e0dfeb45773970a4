// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "nodes/forces/wrench_publisher.h"

#include <ros/console.h>
#include <std_msgs/Float64.h>

#include <algorithm>
#include <utility>

#include "nodes/forces/impedance.h"
#include "nodes/ros/thread_name.h"
#include "nodes/ros/thread_schedule.h"
#include "viscera/model/scene/scene.h"
#include "viscera/tools/trocar.h"

namespace viscera::nodes {
namespace {

using Clock = std::chrono::steady_clock;

/// Limit of waiting for a release at the end. Longer than WrenchSchedule::kRelease_s, even on a busy machine.
constexpr std::chrono::milliseconds kReleaseLimit{40};
/// roscpp writes to sockets on its own thread and does not report when; it has done so after this time.
constexpr std::chrono::milliseconds kFlush{10};
constexpr double kNoForce_n = 1e-9;

}  // namespace

WrenchPublisher::WrenchPublisher(ros::NodeHandle& node, const std::vector<const StylusMailbox*>& mailboxes,
                                 double stall_s, const Scene& scene, const HapticOptions& options)
    : mailboxes_(mailboxes),
      loop_(forceStyluses(options, scene, mailboxes), options.rate_hz > 0, stall_s),
      priority_(options.priority),
      latencies_(mailboxes.size()) {
  for (const StylusMailbox* mailbox : mailboxes_) sinks_.emplace_back(node, mailbox->device());
  for (const StylusMailbox* mailbox : mailboxes_) {
    if (!loop_.betweenTicks()) break;
    energies_.push_back(node.advertise<std_msgs::Float64>(mailbox->config().name + "/energy", 1));
    impedances_.push_back(node.advertise<crtk_msgs::CartesianImpedance>(mailbox->config().name + "/servo_ci", 1));
  }
  thread_ = std::thread([this] { main(); });
}

WrenchPublisher::~WrenchPublisher() {
  release();
  {
    const std::lock_guard<PriorityMutex> lock(mutex_);
    stop_ = true;
  }
  changed_.notify_one();
  thread_.join();
}

void WrenchPublisher::setLimits(size_t stylus, const ForceLimits& limits) {
  {
    const std::lock_guard<PriorityMutex> lock(mutex_);
    loop_.setLimits(stylus, limits);
  }
  changed_.notify_one();
}

void WrenchPublisher::put(const Inputs& inputs) {
  {
    const std::lock_guard<PriorityMutex> lock(mutex_);
    const Clock::time_point now = Clock::now();
    ForceLoop::Ticks ticks;
    for (size_t s = 0; s < inputs.size(); ++s) {
      ticks[s] = {inputs[s].reaction, inputs[s].tracked, inputs[s].contact};
      if (!loop_.updating()) poses_received_[s] = inputs[s].pose_received;
    }
    loop_.put(ticks, stylusesNow(now), now);
    ticked_ = true;
    if (loop_.updating()) return;  // the next period is early enough
    put_ = true;
  }
  changed_.notify_one();
}

void WrenchPublisher::rest() {
  {
    const std::lock_guard<PriorityMutex> lock(mutex_);
    loop_.rest(Clock::now());
    poses_received_ = {};
    put_ = true;
  }
  changed_.notify_one();
}

void WrenchPublisher::release() {
  std::unique_lock<PriorityMutex> lock(mutex_);
  if (loop_.schedule().released()) return;
  loop_.release(Clock::now());
  awaitZeros(lock);
}

void WrenchPublisher::suspend() {
  std::unique_lock<PriorityMutex> lock(mutex_);
  if (loop_.schedule().silenced()) return;
  loop_.suspend(Clock::now());
  awaitZeros(lock);
}

void WrenchPublisher::resume() {
  const std::lock_guard<PriorityMutex> lock(mutex_);
  loop_.resume(Clock::now());
  poses_received_ = {};
}

void WrenchPublisher::awaitZeros(std::unique_lock<PriorityMutex>& lock) {
  put_ = true;
  changed_.notify_one();
  if (sent_.wait_for(lock, kReleaseLimit, [this] { return loop_.schedule().silenced(); }))
    std::this_thread::sleep_for(kFlush);
}

/// Raises the priority of the thread, since late forces are worse than late ticks.
void WrenchPublisher::schedule() {
  if (!loop_.betweenTicks()) return;
  const std::string how = goFirst(priority_);
  const std::lock_guard<PriorityMutex> lock(mutex_);
  scheduling_ = how;
}

ListeningStyluses WrenchPublisher::listening() const {
  ListeningStyluses out{};
  for (size_t s = 0; s < sinks_.size(); ++s) out[s] = sinks_[s].hasSubscribers();
  return out;
}

/// Returns the styluses as the force loop sees them. A stylus with a pressed clutch feels nothing, like one that is not
/// tracked. A device without a subscriber must not feel a jump when it subscribes.
ForceLoop::Inputs WrenchPublisher::stylusesNow(SteadyTime now) const {
  ForceLoop::Inputs out;
  for (size_t s = 0; s < mailboxes_.size(); ++s) {
    const StylusSample sample = mailboxes_[s]->peek(now);
    const Vector3d tip_m = Trocar(mailboxes_[s]->config()).toolPose(sample.pose).position_m;
    out[s] = {sample.valid && !mailboxes_[s]->clutched(), listening_[s], tip_m, sample.received};
  }
  return out;
}

void WrenchPublisher::main() {
  nameThread("wrenches");
  schedule();
  std::unique_lock<PriorityMutex> lock(mutex_);
  while (!stop_) {
    changed_.wait_until(lock, loop_.due(), [this] { return put_ || stop_; });
    if (stop_) return;
    put_ = false;
    const Clock::time_point now = Clock::now();
    const ForceLoop::Inputs inputs = stylusesNow(now);
    const Wrenches wrenches = loop_.next(inputs, now);
    const bool ticked = std::exchange(ticked_, false), live = loop_.schedule().live();
    stalls_ = loop_.schedule().stalls();
    stalled_ = loop_.schedule().stalled();
    lock.unlock();
    const auto sent_force_n = send(wrenches, now);
    if (ticked) sendEnergies();
    if (ticked || !live) sendImpedances(live);
    const ListeningStyluses listening = this->listening();
    lock.lock();
    listening_ = listening;
    loop_.sent(sent_force_n, now);
    const Clock::time_point sent = Clock::now();
    for (size_t s = 0; s < latencies_.size(); ++s) {
      // measures the latency of the force whether the device subscribes or not
      if (loop_.updating()) poses_received_[s] = inputs[s].tracked ? inputs[s].pose_time : SteadyTime{};
      latencies_[s].add(poses_received_[s], sent);
    }
    if (loop_.schedule().silenced()) sent_.notify_all();
  }
}

std::array<Vector3d, layout::kMaxStyluses> WrenchPublisher::send(const Wrenches& wrenches, SteadyTime now) {
  std::array<Vector3d, layout::kMaxStyluses> sent_force_n;
  sent_force_n.fill(Vector3d::Zero());
  const ros::Time stamp = ros::Time::now();
  for (size_t s = 0; s < sinks_.size(); ++s) {
    if (!sinks_[s].hasSubscribers()) continue;
    const DeviceFrame frame = mailboxes_[s]->deviceFrame();
    const Trocar trocar(mailboxes_[s]->config());
    const Reaction wanted =
        trocar.isPresent() ? trocar.deviceReaction(wrenches[s], mailboxes_[s]->peek(now).pose) : wrenches[s];
    sent_force_n[s] = frame.from_tissue.conjugate() * sinks_[s].send(wanted, frame, stamp).force_n;
    // The loop's energies are of the tip's motion, for which the force does the work of that at the device.
    if (trocar.isPresent())
      sent_force_n[s] = wrenches[s].force_n * (sent_force_n[s].norm() / std::max(wanted.force_n.norm(), kNoForce_n));
  }
  return sent_force_n;
}

void WrenchPublisher::sendEnergies() {
  const std::vector<ForceLoop::HapticStats> all = stats();
  for (size_t s = 0; s < energies_.size(); ++s) {
    if (energies_[s].getNumSubscribers() == 0) continue;
    std_msgs::Float64 energy;
    energy.data = all[s].energy_j;
    energies_[s].publish(energy);
  }
}

/// @param live  whether ticks come in time; otherwise the impedance is zero
void WrenchPublisher::sendImpedances(bool live) {
  const ros::Time stamp = ros::Time::now();
  for (size_t s = 0; s < impedances_.size(); ++s) {
    if (impedances_[s].getNumSubscribers() == 0) continue;
    crtk_msgs::CartesianImpedance message = noImpedance(mailboxes_[s]->deviceFrame().name, stamp);
    if (live && !Trocar(mailboxes_[s]->config()).isPresent()) {  // an impedance at the tip is none at the handle
      const std::lock_guard<PriorityMutex> lock(mutex_);
      message = toImpedance(loop_.servo(s), *mailboxes_[s], loop_.schedule().limits(s).force_n, Clock::now(), stamp);
    }
    impedances_[s].publish(message);
  }
}

std::vector<ForceLoop::HapticStats> WrenchPublisher::stats() {
  const std::lock_guard<PriorityMutex> lock(mutex_);
  std::vector<ForceLoop::HapticStats> out;
  for (size_t s = 0; s < mailboxes_.size(); ++s) out.push_back(loop_.stats(s));
  return out;
}

std::string WrenchPublisher::scheduling() {
  const std::lock_guard<PriorityMutex> lock(mutex_);
  return scheduling_;
}

std::vector<LatencyMeter::Reading> WrenchPublisher::takeLatencies() {
  std::vector<LatencyMeter> taken(latencies_.size());
  {
    const std::lock_guard<PriorityMutex> lock(mutex_);
    for (size_t s = 0; s < taken.size(); ++s) taken[s] = latencies_[s].take();
  }
  std::vector<LatencyMeter::Reading> out;
  for (const LatencyMeter& meter : taken) out.push_back(meter.reading());  // sorts, so it runs without the lock
  return out;
}

}  // namespace viscera::nodes
