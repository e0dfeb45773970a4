// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "gpu/program.h"
#include "viscera/solver/state.h"

namespace viscera {

/// Items that a kernel brings to a state: it runs over those of the bodies that are asked for, and each body knows
/// which state its items show.
class BodyItems {
 public:
  struct Range {
    uint32_t first = 0, end = 0;
  };
  BodyItems() = default;
  /// @param ranges  [bodies] items of each, ascending
  explicit BodyItems(std::vector<Range> ranges) : ranges_(std::move(ranges)), followed_(ranges_.size()) {}

  /// The last body has other items from now on; nothing is in place.
  void setLast(Range range);
  /// Runs over what is not there yet. @param asked  [bodies] 1: is asked for; null: all are
  /// @returns whether there was anything
  bool run(const gpu::Program& kernel, const StateView& state, const std::vector<uint8_t>* asked);
  /// Nothing is in place.
  void forget();

 private:
  std::vector<Range> ranges_;
  std::vector<uint32_t> followed_;  ///< [bodies] revision of the state that items show; 0: unknown
};

}  // namespace viscera
