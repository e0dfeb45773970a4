// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <functional>
#include <future>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "viscera/model/scene/overlays.h"
#include "viscera/tools/force_limiter.h"
#include "viscera/tools/stylus.h"

namespace viscera {
class Session;
}

namespace viscera::nodes {

/// The result of a command, as in the service's response.
struct CommandAnswer {
  bool success = false;
  std::string message;
  std::string state_hash;           ///< state hash after a step
  std::vector<Reaction> reactions;  ///< [styluses] reactions after the last tick of a step, tissue frame
  uint64_t tick = 0;
};

/// A request of a service to the simulation thread.
struct Command {
  enum class Kind { kReset, kPause, kResume, kStep, kOverlays, kChange };
  Kind kind = Kind::kReset;
  uint32_t ticks = 0;                    ///< number of ticks of a step
  std::optional<StylusSamples> samples;  ///< samples at the end of a step; empty: from the devices
  std::string camera;                    ///< name of the camera of overlays; empty: all cameras
  Overlays overlays;
  /// Makes a change, while the simulation runs or is paused.
  /// @returns the message of the response   @throws Error reason of the failure
  std::function<std::string(Session&)> change;
  bool leaps = false;                              ///< whether a change jumps to another state, at another tick
  std::chrono::steady_clock::time_point deadline;  ///< time after which the caller does not wait for the answer
  std::shared_ptr<std::atomic<bool>> begun = std::make_shared<std::atomic<bool>>(false);
  std::promise<CommandAnswer> answer;
};

/// Bounded queue of commands from service callbacks to the simulation thread.
class CommandQueue {
 public:
  static constexpr size_t kCapacity = 8;
  /// Additional time that a caller waits for a command that began in time: enough for a slow tick.
  static constexpr std::chrono::seconds kGrace{10};

  /// Enqueues a command and waits for its answer for at most `limit`. Fails at once if the queue is full or closed. A
  /// command is not executed after its caller has given up.
  CommandAnswer call(Command&& command, std::chrono::milliseconds limit);

  /// Returns the next command, if there is one. Called by the simulation thread.
  std::optional<Command> take();
  /// Sleeps until there is a command, the queue is closed or `limit` has passed.
  void wait(std::chrono::milliseconds limit);
  /// Refuses all further commands; waiting commands are answered.
  void close();

 private:
  bool hasBegun(const std::atomic<bool>& begun) const;

  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<Command> commands_;
  bool closed_ = false;
};

}  // namespace viscera::nodes
