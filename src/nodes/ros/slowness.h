// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <utility>

namespace viscera::nodes {

/// Decides when to warn that a simulation is slower than real time, or that images come too rarely. It warns after
/// several slow readings in a row, and warns again only after as many readings in a row were not slow.
class Slowness {
 public:
  explicit Slowness(int readings = 2) : readings_(readings) {}

  /// Adds a reading, once a second. @return  whether to warn now
  bool record(bool slow) {
    in_a_row_ = slow == last_slow_ ? in_a_row_ + 1 : 1;
    last_slow_ = slow;
    if (in_a_row_ < readings_) return false;
    return slow ? !std::exchange(said_, true) : (said_ = false);
  }

 private:
  int readings_;
  int in_a_row_ = 0;
  bool last_slow_ = false, said_ = false;
};

}  // namespace viscera::nodes
