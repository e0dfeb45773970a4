// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>

namespace viscera::nodes {

/// Picks ticks evenly so that a rate is kept, counted in ticks and so free of jitter.
class Throttle {
 public:
  /// @param rate_hz  wanted, > 0   @param tick_hz  of the ticks, > 0
  Throttle(double rate_hz, double tick_hz) : share_(std::min(1.0, rate_hz / tick_hz)) {}

  void setRate(double rate_hz, double tick_hz) { share_ = std::min(1.0, rate_hz / tick_hz); }
  /// Call once in a tick: whether this one is picked. The first one is.
  bool pick() {
    credit_ += share_;
    if (credit_ < 1 - kRounding) return false;
    credit_ -= 1;
    return true;
  }

 private:
  static constexpr double kRounding = 1e-9;  // 90 Hz of 30 Hz must not drift to every fourth tick
  double share_;
  double credit_ = 1;
};

}  // namespace viscera::nodes
