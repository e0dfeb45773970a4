// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <atomic>
#include <cstddef>
#include <future>
#include <vector>

#include "math/processors.h"

namespace viscera {

/// Calls act(0) to act(count - 1), in any order, on as many threads as there are usable processors. Throws the
/// exception of one call after all have ended.
template <class Act>
void inParallel(size_t count, const Act& act) {
  std::atomic<size_t> next{0};
  const auto work = [&] {
    for (size_t i = next++; i < count; i = next++) act(i);
  };
  std::vector<std::future<void>> others;
  for (int t = usableProcessors(); t > 1; --t) others.push_back(std::async(std::launch::async, work));
  work();
  for (std::future<void>& other : others) other.get();
}

}  // namespace viscera
