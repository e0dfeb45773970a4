// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include "math/aligned.h"
#include "solver/cpu/simd/kernels.h"
#include "solver/cpu/store/cpu_store.h"

namespace viscera {

struct CpuStrengths;

/// Arrays of the rows of nodes in and beside thin walls (simd::RowArrays). All they hold is made anew in each substep.
class CpuRows {
 public:
  /// @param strengths  whose brick_walls and wall_rows must not move
  CpuRows(const CpuStore& store, const CpuStrengths& strengths);

  bool empty() const { return place_.empty(); }
  /// All null without thin walls.
  simd::RowArrays arrays();
  const std::vector<uint32_t>& all() const { return all_; }  ///< places
  uint32_t brickOf(uint32_t place) const { return brick_of_[place]; }
  /// Returns the places in and beside bricks, ascending: all that forces of rows on nodes of these bricks come from.
  std::vector<uint32_t> around(const CpuStore& store, const std::vector<uint32_t>& bricks) const;

 private:
  std::vector<uint32_t> place_, brick_of_, all_;
  std::vector<layout::Brick> bricks_;
  AlignedVector<float> values_[3], ends_[3], sums_[3];
  const float* const* walls_ = nullptr;
  const uint16_t* wall_rows_ = nullptr;
};

}  // namespace viscera
