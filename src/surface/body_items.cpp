// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "surface/body_items.h"

#include <algorithm>

#include "surface/surface_kernels.h"

namespace viscera {

void BodyItems::setLast(Range range) {
  ranges_.back() = range;
  clear();
}

void BodyItems::clear() {
  std::fill(followed_.begin(), followed_.end(), 0);
}

bool BodyItems::run(const gpu::Program& kernel, const StateView& state, const std::vector<uint8_t>* asked) {
  const bool known = state.stale_bricks != 0;
  bool any = false;
  Range run;  // of consecutive bodies that show the same state
  uint32_t run_since = 0;
  const auto finish = [&] {
    if (run.first == run.end) return;
    any = true;
    kernel.set("first_item", run.first);
    kernel.set("followed_revision", run_since);
    runOver(kernel, run.end - run.first);
  };
  for (size_t b = 0; b < ranges_.size(); ++b) {
    if (asked && !(*asked)[b]) continue;
    const uint32_t since = known ? followed_[b] : 0;
    followed_[b] = known ? state.revision : 0;
    if (since != 0 && state.moved_revision <= since) continue;
    if (ranges_[b].first != run.end || since != run_since) {
      finish();
      run.first = ranges_[b].first;
      run_since = since;
    }
    run.end = ranges_[b].end;
  }
  finish();
  return any;
}

}  // namespace viscera
