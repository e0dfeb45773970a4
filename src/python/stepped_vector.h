// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "python/stepped.h"
#include "solver/cpu/state/thread_pool.h"

namespace viscera::python {

/// Sessions of one scene on the CPU that are stepped in parallel. A thread takes one session at a time and steps it
/// alone, so that threads do not wait for each other within a tick.
class SteppedVector {
 public:
  /// The data of a call; it stays alive in a call during which another thread closes the vector. Created by makeHere().
  struct Group {
    std::vector<std::shared_ptr<Stepped::Core>> cores;  ///< [sessions]; the first has the model of all
    std::shared_ptr<ThreadPool> threads;
    size_t styluses = 0;
  };

  /// @param threads  0: one per CPU core, at most one per session
  SteppedVector(const SceneSource& scene, size_t sessions, int threads);
  void close() { group_.reset(); }
  bool closed() const { return !group_; }
  size_t sessions() const { return group_ ? group_->cores.size() : 0; }
  /// Returns the data of a call. @throws Error  closed
  std::shared_ptr<const Group> group() const;

  /// Steps session s by ticks[s] ticks with hands[s]. Handles signals such as Ctrl-C. Releases the GIL.
  /// @throws Error  of one session, with its number; the others have been stepped
  void step(const std::vector<StylusSamples>& samples, std::vector<int64_t> ticks) const;
  /// Runs work(core, s) for each of these sessions in parallel, without the GIL.
  /// @throws Error  closed, or an error of work
  void each(const std::vector<size_t>& which, const std::function<void(Stepped::Core&, size_t)>& work) const;

 private:
  std::shared_ptr<const Group> group_;
};

}  // namespace viscera::python
