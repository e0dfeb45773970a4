// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>

namespace viscera::nodes {

/// Picks evenly spaced ticks to keep a rate. It counts ticks and has no jitter.
class Throttle {
 public:
  /// @param rate_hz  desired rate [Hz], > 0   @param tick_hz  rate of the ticks [Hz], > 0
  Throttle(double rate_hz, double tick_hz) : share_(std::min(1.0, rate_hz / tick_hz)) {}

  void setRate(double rate_hz, double tick_hz) { share_ = std::min(1.0, rate_hz / tick_hz); }
  /// Returns whether this tick is picked. Call it once per tick. The first tick is picked.
  bool pick() {
    credit_ += share_;
    if (credit_ < 1 - kRounding) return false;
    credit_ -= 1;
    return true;
  }

 private:
  static constexpr double kRounding = 1e-9;  // 30 Hz at ticks of 90 Hz must not drift to every fourth tick
  double share_;
  double credit_ = 1;
};

}  // namespace viscera::nodes
