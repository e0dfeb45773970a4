// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>

namespace viscera {

// A sum in fixed order: runs of kSumRun terms become one partial sum each, level by level, until one is left. The
// order, and so the rounding, depends only on the number of terms.

constexpr size_t kSumRun = 64;  // measure.comp and sum_impulses.comp use the same number

constexpr size_t sumRuns(size_t terms) {
  return (terms + kSumRun - 1) / kSumRun;
}

/// Returns the number of partial sums of all levels.
inline size_t sumTreeSize(size_t terms) {
  size_t total = 0;
  for (size_t level = sumRuns(terms);; level = sumRuns(level)) {
    total += level;
    if (level <= 1) return total;
  }
}

/// Calls visit(inputs, input_first, output_first, last) for each level. Terms begin at 0; the partial sums of level 1
/// follow them.
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
