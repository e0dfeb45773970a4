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

/// Sums up how long poses took until something that answers them was sent, until asked. Each pose counts once,
/// with the first answer: those that follow it would tell how seldom the device speaks.
class LatencyMeter {
 public:
  static constexpr size_t kKept = 2048;  ///< two seconds of a device of 1 kHz

  struct Reading {
    double mean_s = 0, max_s = 0;  ///< 0 where no pose was answered
    double p50_s = 0, p99_s = 0;   ///< of the newest kKept of them
  };

  /// @param received  when the pose came; 0: there was none   @param sent  when the answer was sent
  void add(SteadyTime received, SteadyTime sent) {
    if (received == SteadyTime{} || received <= last_) return;
    last_ = received;
    const double delay_s = std::chrono::duration<double>(sent - received).count();
    kept_[count_ % kKept] = static_cast<float>(delay_s);
    ++count_;
    sum_s_ += delay_s;
    longest_s_ = std::max(longest_s_, delay_s);
  }
  /// The poses since they were last taken: a copy, to be read where nothing waits for it.
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
