// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "nodes/ros/priority_mutex.h"

#include <gtest/gtest.h>
#include <sched.h>

#include <atomic>
#include <thread>

namespace viscera::nodes {
namespace {

using Clock = std::chrono::steady_clock;
using std::chrono::milliseconds;

/// Runs the calling thread on the first CPU core, with that real-time priority. @returns whether that is permitted
bool runFirst(int priority) {
  cpu_set_t first;
  CPU_ZERO(&first);
  CPU_SET(0, &first);
  sched_param wanted{};
  wanted.sched_priority = priority;
  return sched_setaffinity(0, sizeof first, &first) == 0 &&
         pthread_setschedparam(pthread_self(), SCHED_FIFO, &wanted) == 0;
}

TEST(PriorityMutex, IsHeldByOneAtATime) {
  PriorityMutex mutex;
  const std::lock_guard<PriorityMutex> lock(mutex);
  std::thread([&] { EXPECT_FALSE(mutex.try_lock()); }).join();
}

TEST(PriorityMutex, ConditionWakesWhoWaits) {
  PriorityMutex mutex;
  PriorityCondition condition;
  bool said = false;
  std::thread speaker([&] {
    const std::lock_guard<PriorityMutex> lock(mutex);
    said = true;
    condition.notify_one();
  });
  std::unique_lock<PriorityMutex> lock(mutex);
  EXPECT_TRUE(condition.wait_for(lock, std::chrono::seconds(10), [&] { return said; }));
  lock.unlock();
  speaker.join();
}

TEST(PriorityMutex, ConditionGivesUpWhenDueAndHoldsTheLock) {
  PriorityMutex mutex;
  PriorityCondition condition;
  std::unique_lock<PriorityMutex> lock(mutex);
  const Clock::time_point begun = Clock::now();
  EXPECT_FALSE(condition.wait_until(lock, begun + milliseconds(20), [] { return false; }));
  EXPECT_GE(Clock::now() - begun, milliseconds(20));
  std::thread([&] { EXPECT_FALSE(mutex.try_lock()); }).join();
}

/// On one CPU core a thread of low priority holds the mutex while one of middle priority keeps working. One of high
/// priority that waits for the mutex must not wait for that work.
TEST(PriorityMutex, HolderThatOthersKeepFromRunningRunsWithThePriorityOfWhoWaits) {
  constexpr milliseconds kWork{200};  // less than the kernel gives to real-time threads per second
  PriorityMutex mutex;
  std::atomic<bool> held{false}, working{false}, permitted{true};
  Clock::duration waited{};
  std::thread low([&] {
    permitted = permitted && runFirst(1);
    const std::lock_guard<PriorityMutex> lock(mutex);
    held = true;
    while (!working && permitted) std::this_thread::sleep_for(milliseconds(1));
    for (const Clock::time_point begun = Clock::now(); Clock::now() - begun < milliseconds(5);) {
    }
  });
  while (!held) std::this_thread::yield();
  std::thread middle([&] {
    permitted = permitted && runFirst(2);
    working = true;
    for (const Clock::time_point begun = Clock::now(); permitted && Clock::now() - begun < kWork;) {
    }
  });
  std::thread high([&] {
    permitted = permitted && runFirst(3);
    while (!working && permitted) std::this_thread::sleep_for(milliseconds(1));
    std::this_thread::sleep_for(milliseconds(5));
    const Clock::time_point begun = Clock::now();
    const std::lock_guard<PriorityMutex> lock(mutex);
    waited = Clock::now() - begun;
  });
  low.join();
  middle.join();
  high.join();
  if (!permitted) GTEST_SKIP() << "SCHED_FIFO is not permitted";
  EXPECT_LT(waited, kWork / 2);
}

}  // namespace
}  // namespace viscera::nodes
