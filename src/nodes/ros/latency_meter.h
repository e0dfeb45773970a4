// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdint>
#include <vector>

#include "viscera/math/types.h"

namespace viscera::nodes {

/// Measures the time from the arrival of a pose to the first answer to it. Later answers to the same pose do not count:
/// they would measure the rate of the device.
class LatencyMeter {
 public:
  static constexpr size_t kKept = 2048;  ///< number of kept latencies: two seconds of a device of 1 kHz

  struct Reading {
    double mean_s = 0, max_s = 0;  ///< mean and largest latency [s]; 0 if no pose was answered
    double p50_s = 0, p99_s = 0;   ///< median and 99th percentile of the newest kKept latencies [s]
  };

  /// Adds an answer. @param received  arrival of the pose; 0: no pose   @param sent  time of the answer
  void add(SteadyTime received, SteadyTime sent) {
    if (received == SteadyTime{} || received <= last_) return;
    last_ = received;
    const double delay_s = std::chrono::duration<double>(sent - received).count();
    kept_[count_ % kKept] = static_cast<float>(delay_s);
    ++count_;
    sum_s_ += delay_s;
    longest_s_ = std::max(longest_s_, delay_s);
  }
  /// Returns a copy of the measurements since the last call and starts the next measurement. The caller reads the copy
  /// without a lock.
  LatencyMeter take() {
    const LatencyMeter out = *this;
    count_ = 0;
    sum_s_ = longest_s_ = 0;
    return out;
  }
  Reading reading() const {
    if (count_ == 0) return {};
    Reading out;
    out.mean_s = sum_s_ / static_cast<double>(count_);
    out.max_s = longest_s_;
    std::vector<float> sorted(kept_.begin(),
                              kept_.begin() + static_cast<std::ptrdiff_t>(std::min<uint64_t>(count_, kKept)));
    std::sort(sorted.begin(), sorted.end());
    const auto at = [&](double share) {
      return sorted[static_cast<size_t>(share * static_cast<double>(sorted.size() - 1))];
    };
    out.p50_s = at(0.5);
    out.p99_s = at(0.99);
    return out;
  }

 private:
  SteadyTime last_{};
  uint64_t count_ = 0;
  std::array<float, kKept> kept_{};
  double sum_s_ = 0, longest_s_ = 0;
};

}  // namespace viscera::nodes
