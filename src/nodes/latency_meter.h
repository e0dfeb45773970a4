// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <chrono>
#include <cstdint>

#include "viscera/math/types.h"

namespace viscera::nodes {

/// Sums up how long poses took until something that answers them was sent, until somebody asks. Each pose counts once,
/// with the first answer: those that follow it would tell how seldom the device speaks.
class LatencyMeter {
 public:
  struct Reading {
    double mean_s = 0, max_s = 0;  ///< 0 where no pose was answered
  };

  /// @param received  when the pose came; 0: there was none   @param sent  when the answer was sent
  void add(SteadyTime received, SteadyTime sent) {
    if (received == SteadyTime{} || received <= last_) return;
    last_ = received;
    const double delay_s = std::chrono::duration<double>(sent - received).count();
    ++count_;
    sum_s_ += delay_s;
    longest_s_ = std::max(longest_s_, delay_s);
  }
  /// The poses since the last reading.
  Reading take() {
    Reading out;
    if (count_) out = {sum_s_ / static_cast<double>(count_), longest_s_};
    count_ = 0;
    sum_s_ = longest_s_ = 0;
    return out;
  }

 private:
  SteadyTime last_{};
  uint64_t count_ = 0;
  double sum_s_ = 0, longest_s_ = 0;
};

}  // namespace viscera::nodes
