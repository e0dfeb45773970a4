// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "python/stepped.h"
#include "solver/cpu/store/thread_pool.h"

namespace viscera::python {

/// Sessions of one scene, on the processor, that are stepped side by side: a thread takes one session at a time and
/// steps it alone, so that threads do not wait for each other within a tick.
class SteppedVector {
 public:
  /// What calls need; lives on through a call in which another thread closes the vector. Of makeHere().
  struct Group {
    std::vector<std::shared_ptr<Stepped::Core>> cores;  ///< [sessions]; the first has the model of all
    std::shared_ptr<ThreadPool> threads;
    size_t styluses = 0;
  };

  /// @param threads  0: one per processor, of sessions at most
  SteppedVector(const SceneSource& scene, size_t sessions, int threads);
  void close() { group_.reset(); }
  bool closed() const { return !group_; }
  size_t sessions() const { return group_ ? group_->cores.size() : 0; }
  /// @throws Error  closed
  std::shared_ptr<const Group> group() const;

  /// ticks[s] ticks of session s with hands[s]; signals such as Ctrl-C are heard. The GIL is released.
  /// @throws Error  of one of them, with its number; the others have been stepped
  void step(const std::vector<StylusSamples>& hands, std::vector<int64_t> ticks) const;
  /// Runs work(core, s) of each of these sessions side by side, without the GIL. @throws Error  closed, and what it
  /// throws
  void each(const std::vector<size_t>& which, const std::function<void(Stepped::Core&, size_t)>& work) const;

 private:
  std::shared_ptr<const Group> group_;
};

}  // namespace viscera::python
