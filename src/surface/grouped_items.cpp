// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "surface/grouped_items.h"

#include <algorithm>
#include <numeric>

#include "layout/bindings.h"
#include "surface/surface_kernels.h"

namespace viscera {

GroupedItems::GroupedItems(const std::vector<uint32_t>& item_groups, size_t groups, size_t spare, const char* name)
    : name_(name), starts_(groups + 1), followed_(groups), ways_(groups), listed_ways_(groups) {
  for (const uint32_t group : item_groups) {
    if (group < groups) ++starts_[group + 1];
  }
  std::partial_sum(starts_.begin(), starts_.end(), starts_.begin());
  items_.resize(starts_.back());
  std::vector<uint32_t> next(starts_.begin(), starts_.end() - 1);
  for (uint32_t item = 0; item < item_groups.size(); ++item) {
    if (item_groups[item] < groups) items_[next[item_groups[item]]++] = item;
  }
  list_ = gpu::Buffer<uint32_t>(items_.size() + spare, name_);
}

void GroupedItems::setLast(uint32_t first, uint32_t end) {
  items_.resize(starts_[starts_.size() - 2] + (end - first));
  std::iota(items_.begin() + starts_[starts_.size() - 2], items_.end(), first);
  starts_.back() = static_cast<uint32_t>(items_.size());
  if (items_.size() > list_.size()) list_ = gpu::Buffer<uint32_t>(items_.size() + items_.size() / 2, name_);
  listed_.clear();
  std::fill(listed_ways_.begin(), listed_ways_.end(), kNot);
  forget();
}

void GroupedItems::forget() {
  std::fill(followed_.begin(), followed_.end(), 0);
  last_ = 0;
}

/// What is to be done for each group. What shows the last run's state follows from there; all others from scratch.
void GroupedItems::choose(const StateView& state, const std::vector<uint8_t>* needed) {
  const bool known = state.stale_bricks != 0;
  for (size_t g = 0; g < ways_.size(); ++g) {
    ways_[g] = kNot;
    if (needed && !(*needed)[g]) continue;
    if (!(known && followed_[g] != 0 && state.moved_revision <= followed_[g]))
      ways_[g] = known && last_ != 0 && followed_[g] == last_ ? kFollow : kAnew;
    followed_[g] = known ? state.revision : 0;
  }
  last_ = known ? state.revision : 0;
}

void GroupedItems::list() {
  if (ways_ == listed_ways_) return;
  listed_ways_ = ways_;
  listed_.clear();
  for (const Way way : {kFollow, kAnew}) {
    for (size_t g = 0; g < ways_.size(); ++g) {
      if (ways_[g] == way) listed_.insert(listed_.end(), items_.begin() + starts_[g], items_.begin() + starts_[g + 1]);
    }
    if (way == kFollow) follow_count_ = listed_.size();
  }
  list_.write(listed_);
}

bool GroupedItems::run(const gpu::Program& kernel, const StateView& state, const std::vector<uint8_t>* needed) {
  const uint32_t since = last_;
  choose(state, needed);
  list();
  if (listed_.empty()) return false;
  list_.bindStorage(layout::kBindPicked);
  const auto over = [&](size_t first, size_t end, uint32_t followed_revision) {
    if (first == end) return;
    kernel.set("first", static_cast<uint32_t>(first));
    kernel.set("followed_revision", followed_revision);
    runOver(kernel, end - first);
  };
  over(0, follow_count_, since);
  over(follow_count_, listed_.size(), 0);
  return true;
}

}  // namespace viscera
