// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <cstdint>

#include "viscera/math/types.h"

namespace viscera::nodes {

/// Measures the rate of an event.
class RateMeter {
 public:
  void add() { ++count_; }
  /// Returns the rate since the last call [Hz]; 0 at the first call.
  double take(SteadyTime now) {
    const double since_s = before_ == SteadyTime{} ? 0 : std::chrono::duration<double>(now - before_).count();
    const double rate_hz = since_s > 0 ? static_cast<double>(count_) / since_s : 0;
    before_ = now;
    count_ = 0;
    return rate_hz;
  }

 private:
  SteadyTime before_{};
  uint64_t count_ = 0;
};

}  // namespace viscera::nodes
