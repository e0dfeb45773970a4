// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include "gpu/buffer.h"
#include "gpu/program.h"
#include "viscera/solver/state.h"

namespace viscera {

/// Items that a kernel brings to a state (PICKED in shaders/surface/), in groups: it runs over those of the groups that
/// are asked for, and each group knows which state its items show.
class GroupedItems {
 public:
  GroupedItems() = default;
  /// @param item_groups  [items] group of each item; items that are not mapped have one >= `groups`
  /// @param spare  items that the last group may get without a larger buffer   @param name  for messages, a literal
  GroupedItems(const std::vector<uint32_t>& item_groups, size_t groups, size_t spare, const char* name);

  /// The last group has, instead of those it was made with, the items from first to end.
  void setLast(uint32_t first, uint32_t end);
  /// Runs over what is not there yet. @param needed  [groups] 1: is asked for; null: all are
  /// @returns whether there was anything
  bool run(const gpu::Program& kernel, const StateView& state, const std::vector<uint8_t>* needed);
  /// Nothing is in place.
  void forget();

 private:
  enum Way : uint8_t { kNot, kFollow, kAnew };
  void choose(const StateView& state, const std::vector<uint8_t>* needed);
  void list();

  const char* name_ = "";
  std::vector<uint32_t> items_, starts_;  ///< group by group; [groups + 1]
  std::vector<uint32_t> followed_;        ///< [groups] revision of the state that items show; 0: unknown
  std::vector<Way> ways_, listed_ways_;   ///< [groups] of this run, of what is in the list
  std::vector<uint32_t> listed_;
  size_t follow_count_ = 0;
  uint32_t last_ = 0;  ///< revision of the last run
  gpu::Buffer<uint32_t> list_;
};

}  // namespace viscera
