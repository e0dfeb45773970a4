// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>

namespace viscera {

// A sum in a fixed order: runs of kSumRun terms become one partial sum each, level by level, until one is left. The
// order depends on the number of terms only, and so does the rounding.

constexpr size_t kSumRun = 64;  // measure.comp and sum_impulses.comp know the same number

constexpr size_t sumRuns(size_t terms) {
  return (terms + kSumRun - 1) / kSumRun;
}

/// Partial sums of all levels together.
inline size_t sumTreeSize(size_t terms) {
  size_t total = 0;
  for (size_t level = sumRuns(terms);; level = sumRuns(level)) {
    total += level;
    if (level <= 1) return total;
  }
}

/// Calls visit(inputs, input_first, output_first, last) per level; terms lie at 0, partial sums of level 1 behind.
template <class Visit>
void forEachSumLevel(size_t terms, Visit visit) {
  size_t inputs = terms, input_first = 0, output_first = terms;
  do {
    const size_t outputs = sumRuns(inputs);
    visit(inputs, input_first, output_first, outputs <= 1);
    input_first = output_first;
    output_first += outputs;
    inputs = outputs;
  } while (inputs > 1);
}

}  // namespace viscera
