// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "nodes/input/sender_watch.h"

#include <iterator>

namespace viscera::nodes {
namespace {

constexpr std::chrono::seconds kRecent{1};  ///< a restarted driver has another name, and the old one is gone

}  // namespace

bool SenderWatch::record(const std::string& node, SteadyTime now) {
  const std::lock_guard<std::mutex> lock(mutex_);
  last_[node] = now;
  if (last_.size() < 2) return false;
  for (auto sender = last_.begin(); sender != last_.end();)
    sender = now - sender->second > kRecent ? last_.erase(sender) : std::next(sender);
  if (last_.size() < 2 || said_) return false;
  return said_ = true;
}

std::string SenderWatch::several(SteadyTime now) const {
  const std::lock_guard<std::mutex> lock(mutex_);
  std::string names;
  size_t count = 0;
  for (const auto& [name, time] : last_) {
    if (now - time > kRecent) continue;
    names += (count++ ? ", " : "") + name;
  }
  return count > 1 ? names : "";
}

}  // namespace viscera::nodes
