// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <chrono>

namespace viscera::nodes {

/// Start times of ticks on the steady clock. A loop that falls behind keeps a debt of at most one tick, so it does not
/// race after a pause of the machine.
class Pacer {
 public:
  using Time = std::chrono::steady_clock::time_point;
  using Span = std::chrono::steady_clock::duration;

  /// @param period_s  duration of a tick [s], > 0
  explicit Pacer(double period_s)
      : period_(std::chrono::duration_cast<Span>(std::chrono::duration<double>(period_s))) {}

  /// Returns the earliest start of the tick after the one that just ended; `now` is the current time.
  Time next(Time now) {
    due_ = std::max(due_ + period_, now - period_);
    return due_;
  }
  /// Sets the start of the next tick to one period after `now`.
  void restart(Time now) { due_ = now; }

 private:
  Span period_;
  Time due_{};
};

}  // namespace viscera::nodes
