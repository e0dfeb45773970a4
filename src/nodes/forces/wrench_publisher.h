// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ros/node_handle.h>

#include <atomic>
#include <thread>
#include <vector>

#include "haptics/force_loop.h"
#include "nodes/forces/force_sink.h"
#include "nodes/forces/haptic_options.h"
#include "nodes/input/stylus_mailbox.h"
#include "nodes/ros/latency_meter.h"
#include "nodes/ros/priority_mutex.h"

namespace viscera {
struct Scene;
}

namespace viscera::nodes {

/// Sends forces to the devices, each through its ForceSink, on a thread that never waits: neither for the simulation
/// nor for publishers of images. It detects a stalled simulation and then sends zeros.
class WrenchPublisher {
 public:
  /// Results of a tick for one stylus.
  struct Input {
    Reaction reaction;
    SteadyTime pose_received{};  ///< arrival of the pose that the reaction answers; 0: none
    bool tracked = false;        ///< whether the stylus is tracked
    TickContact contact;
  };
  using Inputs = std::array<Input, layout::kMaxStyluses>;

  /// @param mailboxes  mailboxes of the scene's styluses, in order; they must outlive this object
  /// @param stall_s    longest time between two ticks that is not a stall [s]
  /// @param options    options of the forces between two ticks
  WrenchPublisher(ros::NodeHandle& node, const std::vector<const StylusMailbox*>& mailboxes, double stall_s,
                  const Scene& scene, const HapticOptions& options);
  ~WrenchPublisher();
  WrenchPublisher(const WrenchPublisher&) = delete;
  WrenchPublisher& operator=(const WrenchPublisher&) = delete;

  void setLimits(size_t stylus, const ForceLimits& limits);
  void put(const Inputs& inputs);
  /// Stops forces until the next put(), because there are no ticks.
  void rest();
  /// Sends zeros, and nothing after them. Waits until they are written to the devices, for at most kReleaseLimit.
  void release();
  /// Sends zeros as release() does, until resume(). Called before the process is stopped.
  void suspend();
  void resume();

  /// Returns the latencies since the last call, from the arrival of a pose to the sending of its force: [styluses].
  std::vector<LatencyMeter::Reading> takeLatencies();
  /// Returns statistics of the loop between ticks: [styluses].
  std::vector<ForceLoop::HapticStats> stats();
  /// Returns how the thread is scheduled: "SCHED_FIFO 20", or the reason why it is not.
  std::string scheduling();
  uint64_t stalls() const { return stalls_; }
  bool stalled() const { return stalled_; }

 private:
  void main();
  void schedule();
  /// Waits until zeros are written to the devices, for at most kReleaseLimit.
  void awaitZeros(std::unique_lock<PriorityMutex>& lock);
  /// Returns which devices subscribe to forces.
  ListeningStyluses listening() const;
  ForceLoop::Inputs stylusesNow(SteadyTime now) const;
  /// Sends wrenches to the devices. @returns the forces of the devices' motors, in the axes of the tissue frame
  std::array<Vector3d, layout::kMaxStyluses> send(const Wrenches& wrenches, SteadyTime now);
  void sendEnergies();
  void sendImpedances(bool live);

  std::vector<const StylusMailbox*> mailboxes_;
  std::vector<ForceSink> sinks_;  ///< [styluses]

  PriorityMutex mutex_;
  PriorityCondition changed_, sent_;
  ForceLoop loop_;
  const int priority_;
  std::string scheduling_;
  std::vector<ros::Publisher> energies_, impedances_;  ///< [styluses]
  std::array<SteadyTime, layout::kMaxStyluses> poses_received_{};
  bool put_ = false, stop_ = false;
  bool ticked_ = false;  ///< whether there was a tick since the last message
  ListeningStyluses listening_{};
  std::vector<LatencyMeter> latencies_;
  std::atomic<uint64_t> stalls_{0};
  std::atomic<bool> stalled_{false};
  std::thread thread_;
};

}  // namespace viscera::nodes
