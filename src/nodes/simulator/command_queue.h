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

/// What came of a command, in the words of the service's answer.
struct CommandAnswer {
  bool success = false;
  std::string message;
  std::string state_hash;           ///< of a step
  std::vector<Reaction> reactions;  ///< of a step: [styluses] after its last tick, tissue frame
  uint64_t tick = 0;
};

/// Something that a service asks of the simulation's thread.
struct Command {
  enum class Kind { kReset, kPause, kResume, kStep, kOverlays, kChange };
  Kind kind = Kind::kReset;
  uint32_t ticks = 0;                    ///< of a step
  std::optional<StylusSamples> samples;  ///< of a step: where the styluses are at its end; else as devices say
  std::string camera;                    ///< of overlays: by name; empty: all
  Overlays overlays;
  /// Of a change: makes it, running or paused. @returns what to answer  @throws Error  why not
  std::function<std::string(Session&)> change;
  bool leaps = false;                              ///< of a change: to another state, at another tick
  std::chrono::steady_clock::time_point deadline;  ///< the answer is not waited for after this
  std::shared_ptr<std::atomic<bool>> begun = std::make_shared<std::atomic<bool>>(false);
  std::promise<CommandAnswer> answer;
};

/// Bounded queue of commands from service callbacks to the simulation's thread.
class CommandQueue {
 public:
  static constexpr size_t kCapacity = 8;
  /// How much longer than its limit a caller waits for a command that was begun in time: a tick, however slow.
  static constexpr std::chrono::seconds kGrace{10};

  /// Hands a command over and waits for its answer until `limit` has passed; fails at once if the queue is full or
  /// closed. A command whose caller has given up is not executed.
  CommandAnswer call(Command&& command, std::chrono::milliseconds limit);

  /// Next command, if one waits. For the simulation's thread.
  std::optional<Command> take();
  /// Sleeps until a command waits, the queue is closed or `limit` has passed.
  void wait(std::chrono::milliseconds limit);
  /// Refuses all commands from now on; those that wait are answered.
  void close();

 private:
  bool hasBegun(const std::atomic<bool>& begun) const;

  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<Command> commands_;
  bool closed_ = false;
};

}  // namespace viscera::nodes
