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
#include "nodes/hands/stylus_mailbox.h"
#include "nodes/ros/latency_meter.h"
#include "nodes/ros/priority_mutex.h"

namespace viscera {
struct Scene;
}

namespace viscera::nodes {

/// Forces to the devices, each to its ForceSink, from a thread that never waits: neither for the simulation, whose
/// stall it notices and answers with zeros, nor for those who show pictures.
class WrenchPublisher {
 public:
  /// What a tick has for a stylus.
  struct Hand {
    Reaction reaction;
    SteadyTime pose_received{};  ///< of the pose that the reaction answers; 0: none
    bool tracked = false;        ///< a hand is there
    TickContact contact;
  };
  using Hands = std::array<Hand, layout::kMaxStyluses>;

  /// @param mailboxes  of the scene's styluses, in order; they must outlive this
  /// @param stall_s    a tick that comes later than this after the one before is a stall [s]
  /// @param options    of what is sent between two ticks
  WrenchPublisher(ros::NodeHandle& node, const std::vector<const StylusMailbox*>& mailboxes, double stall_s,
                  const Scene& scene, const HapticOptions& options);
  ~WrenchPublisher();
  WrenchPublisher(const WrenchPublisher&) = delete;
  WrenchPublisher& operator=(const WrenchPublisher&) = delete;

  void setLimits(size_t stylus, const ForceLimits& limits);
  void put(const Hands& hands);
  /// There are no ticks and so no forces until the next put().
  void rest();
  /// Zeros go out, and nothing else ever again; waits until they are written to the devices, at most kReleaseLimit.
  void release();
  /// As release(), until resume(): the process is about to be stopped.
  void suspend();
  void resume();

  /// From the arrival of a pose to the sending of the force that answers it, since they were last taken: [styluses].
  std::vector<LatencyMeter::Reading> takeLatencies();
  /// [styluses] what the loop between ticks has done so far.
  std::vector<ForceLoop::Felt> felt();
  /// How the thread is scheduled: "SCHED_FIFO 20", or why not.
  std::string scheduling();
  uint64_t stalls() const { return stalls_; }
  bool stalled() const { return stalled_; }

 private:
  void main();
  void schedule();
  /// Waits until zeros are written to the devices, at most kReleaseLimit.
  void awaitZeros(std::unique_lock<PriorityMutex>& lock);
  /// Which devices listen.
  HandsThere listening() const;
  ForceLoop::Hands handsNow(SteadyTime now) const;
  /// @returns what hands are told by it: forces of their motors, axes of the tissue frame
  std::array<Vector3d, layout::kMaxStyluses> send(const Wrenches& wrenches);
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
  bool ticked_ = false;  ///< since the last message
  HandsThere listening_{};
  std::vector<LatencyMeter> latencies_;
  std::atomic<uint64_t> stalls_{0};
  std::atomic<bool> stalled_{false};
  std::thread thread_;
};

}  // namespace viscera::nodes
