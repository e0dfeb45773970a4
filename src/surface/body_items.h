// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "gpu/program.h"
#include "viscera/solver/state.h"

namespace viscera {

/// Items (vertices, nodes) that a kernel updates to a state, for the requested bodies only. Keeps the state that the
/// items of each body show.
class BodyItems {
 public:
  struct Range {
    uint32_t first = 0, end = 0;
  };
  BodyItems() = default;
  /// @param ranges  [bodies] items of each, ascending
  explicit BodyItems(std::vector<Range> ranges) : ranges_(std::move(ranges)), followed_(ranges_.size()) {}

  /// Replaces the items of the last body, and marks all items of all bodies as not up to date.
  void setLast(Range range);
  /// Runs over the items that are not up to date. @param asked  [bodies] 1: requested; null: all are
  /// @returns whether there were any
  bool run(const gpu::Program& kernel, const StateView& state, const std::vector<uint8_t>* asked);
  /// Marks all items as not up to date.
  void clear();

 private:
  std::vector<Range> ranges_;
  std::vector<uint32_t> followed_;  ///< [bodies] revision of the state that items show; 0: unknown
};

}  // namespace viscera
