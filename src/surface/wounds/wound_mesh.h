// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace viscera {

/// Triangles that are added and removed, stored without gaps, each listed at its corners. It keeps its memory for
/// reuse.
class WoundMesh {
 public:
  static constexpr uint32_t kNone = UINT32_MAX;

  void clear();
  /// Adds a triangle. @param order  among triangles   @returns its name, which stays the same
  uint32_t add(const std::array<uint32_t, 3>& corners, uint64_t order);
  void remove(uint32_t name);
  bool isThis(uint32_t name, const std::array<uint32_t, 3>& corners, uint64_t order) const;

  const std::vector<uint32_t>& corners() const { return corners_; }  ///< [3 * n]
  std::array<uint32_t, 3> cornersOf(uint32_t name) const {
    const uint32_t* const at = &corners_[3 * size_t{position_of_[name]}];
    return {at[0], at[1], at[2]};
  }
  uint64_t orderOf(uint32_t name) const { return orders_[name]; }
  /// Visits the triangles at a vertex, in no order: visit(name, which of its corners it is).
  template <class Visit>
  void forEachAt(uint32_t vertex, Visit visit) const {
    for (uint32_t link = vertex < first_.size() ? first_[vertex] : kNone; link != kNone; link = next_[link])
      visit(link / 3, link % 3);
  }
  size_t made() const { return made_; }

 private:
  std::vector<uint32_t> corners_;      ///< [3 * n] by place
  std::vector<uint32_t> names_;        ///< [n] by place
  std::vector<uint32_t> position_of_;  ///< [names]
  std::vector<uint64_t> orders_;       ///< [names]
  std::vector<uint32_t> next_;         ///< [3 * names] of the corners at a vertex: 3 * name + corner, or kNone
  std::vector<uint32_t> first_;        ///< [vertices]
  std::vector<uint32_t> free_;         ///< names
  size_t made_ = 0;
};

}  // namespace viscera
