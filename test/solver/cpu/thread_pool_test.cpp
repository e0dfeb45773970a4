// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "solver/cpu/state/thread_pool.h"

#include <gtest/gtest.h>
#include <time.h>

#include <algorithm>
#include <chrono>
#include <numeric>
#include <stdexcept>
#include <string>

using namespace viscera;

namespace {

/// Returns the processor time of all threads of this process [s].
double processorTime() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

void rest(std::chrono::microseconds time) {
  std::this_thread::sleep_for(time);
}

/// Runs rounds of jobs of varying number; each must have run once when a round ends.
void expectEveryJobOnce(const ThreadPool& pool, int rounds, std::chrono::microseconds between) {
  std::vector<std::atomic<uint32_t>> runs(100);
  for (int round = 0; round < rounds; ++round) {
    const size_t count = static_cast<size_t>(round * 7) % (runs.size() + 1);
    for (auto& n : runs) n = 0;
    pool(count, [&](size_t i) { ++runs[i]; });
    for (size_t i = 0; i < runs.size(); ++i) ASSERT_EQ(runs[i], i < count ? 1u : 0u) << "round " << round;
    if (between.count() > 0) rest(between);
  }
}

}  // namespace

TEST(ThreadPool, RunsEveryJobOnceInRoundsThatFollowAtOnce) {
  for (int threads = 1; threads <= 4; ++threads) {
    SCOPED_TRACE(threads);
    const ThreadPool pool(threads);
    EXPECT_EQ(pool.threads(), threads);
    expectEveryJobOnce(pool, 20000, std::chrono::microseconds(0));
  }
}

TEST(ThreadPool, RunsEveryJobOnceWhereThreadsHaveGoneToSleepBetweenRounds) {
  for (int threads = 2; threads <= 4; ++threads) {
    SCOPED_TRACE(threads);
    const ThreadPool pool(threads);
    expectEveryJobOnce(pool, 200, std::chrono::microseconds(20));   // some still spin
    expectEveryJobOnce(pool, 200, std::chrono::microseconds(200));  // all are asleep
  }
}

TEST(ThreadPool, JobsSeeWhatWasWrittenBeforeAndTheCallerWhatTheyWrote) {
  const ThreadPool pool(3);
  std::vector<uint64_t> values(64);  // no atomics: the rounds themselves must keep order
  for (uint64_t round = 1; round <= 5000; ++round) {
    const uint64_t sum = std::accumulate(values.begin(), values.end(), uint64_t{0});
    ASSERT_EQ(sum, (round - 1) * values.size());
    pool(values.size(), [&](size_t i) { values[(i + round) % values.size()] += 1; });
  }
}

TEST(ThreadPool, OtherThreadsTakeWhatOneIsSlowWith) {
  const ThreadPool pool(2);
  std::atomic<int> done{0};
  std::atomic<bool> waited_in_vain{false};
  pool(8, [&](size_t) {
    // One of the jobs waits for all others: only the other thread can run them.
    if (done++ != 0) return;
    const auto until = std::chrono::steady_clock::now() + std::chrono::seconds(10);
    while (done < 8 && std::chrono::steady_clock::now() < until) std::this_thread::yield();
    waited_in_vain = done < 8;
  });
  EXPECT_FALSE(waited_in_vain);
}

TEST(ThreadPool, IdleThreadsTakeNoProcessorTime) {
  constexpr double kIdle_s = 0.2, kBusyShare = 0.05;  // a thread that spins takes 1.0, or what the machine has left
  const ThreadPool pool(4);
  std::atomic<int> jobs{0};
  pool(100, [&](size_t) { ++jobs; });
  rest(std::chrono::milliseconds(5));  // they spin for a while, 50 us each
  const double before = processorTime();
  rest(std::chrono::milliseconds(static_cast<int>(1000 * kIdle_s)));
  EXPECT_LT(processorTime() - before, kBusyShare * kIdle_s);
  EXPECT_EQ(jobs, 100);
}

TEST(ThreadPool, ComesAndGoesWithoutWork) {
  for (int i = 0; i < 50; ++i) {
    const ThreadPool pool(1 + i % 4);
    if (i % 2) rest(std::chrono::microseconds(100));
  }
}

TEST(ThreadPool, PoolsDoNotDisturbEachOther) {
  const ThreadPool one(2), other(2);
  std::atomic<int> outer{0}, inner{0};
  std::thread second([&] {
    for (int round = 0; round < 2000; ++round) other(5, [&](size_t) { ++inner; });
  });
  for (int round = 0; round < 2000; ++round) one(7, [&](size_t) { ++outer; });
  second.join();
  EXPECT_EQ(outer, 14000);
  EXPECT_EQ(inner, 10000);
}

TEST(ThreadPool, CallersOnSeveralThreadsTakeTurns) {
  const ThreadPool pool(3);
  std::vector<std::thread> callers;
  for (int caller = 0; caller < 4; ++caller) {
    callers.emplace_back([&, caller] { expectEveryJobOnce(pool, 2000, std::chrono::microseconds(caller)); });
  }
  for (std::thread& caller : callers) caller.join();
}

TEST(ThreadPool, HasTheThreadsAskedForOrThoseOfTheMachine) {
  EXPECT_EQ(makeThreadPool(3)->threads(), 3);
  EXPECT_GE(makeThreadPool()->threads(), 1);
}

TEST(ThreadPool, RangesAreEveryItemOnceInPortionsThatEndSmall) {
  constexpr Portions kPortions{2, 16};
  for (int threads = 1; threads <= 4; ++threads) {
    const ThreadPool pool(threads);
    for (const size_t count : {0, 1, 2, 15, 64, 1000}) {
      std::vector<std::atomic<uint32_t>> runs(count);
      std::atomic<size_t> largest{0};
      pool.ranges(count, kPortions, [&](size_t first, size_t end) {
        for (size_t i = first; i < end; ++i) ++runs[i];
        for (size_t most = largest; most < end - first && !largest.compare_exchange_weak(most, end - first);) {
        }
      });
      for (const auto& n : runs) ASSERT_EQ(n, 1u) << count;
      EXPECT_LE(largest, kPortions.most);
    }
  }
}

TEST(ThreadPool, RunsEveryJobOnceWhileThreadsJoinAndLeave) {
  ThreadPool pool(4);
  std::atomic<bool> stop{false};
  std::thread other([&] {
    for (int i = 1; !stop; ++i) pool.limit(1 + i % 4);
  });
  expectEveryJobOnce(pool, 5000, std::chrono::microseconds(0));
  expectEveryJobOnce(pool, 100, std::chrono::microseconds(500));  // some are asleep
  stop = true;
  other.join();
}

TEST(ThreadPool, ThreadsThatAreLeftOutTakeNoProcessorTime) {
  constexpr double kBusy_s = 0.2, kMore = 0.1;  // share of the caller's time
  ThreadPool pool(3);
  pool.limit(1);
  const auto rounds = [&](double seconds) {
    const auto until = std::chrono::steady_clock::now() + std::chrono::duration<double>(seconds);
    while (std::chrono::steady_clock::now() < until) pool(10, [](size_t) {});
  };
  rounds(0.01);
  EXPECT_EQ(pool.sharing(), 1);
  timespec own{};
  const double before = processorTime();
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &own);
  const double own_before = static_cast<double>(own.tv_sec) + 1e-9 * static_cast<double>(own.tv_nsec);
  rounds(kBusy_s);
  const double all = processorTime() - before;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &own);
  const double mine = static_cast<double>(own.tv_sec) + 1e-9 * static_cast<double>(own.tv_nsec) - own_before;
  EXPECT_LT(all - mine, kMore * mine);
}

TEST(ThreadPool, WhatAJobThrowsIsThrownToTheCallerAndTheNextRoundIsWhole) {
  for (const int threads : {1, 2, 4}) {
    const ThreadPool pool(threads);
    for (const size_t bad : {0, 37, 99}) {
      std::atomic<uint32_t> runs{0};
      std::string said;
      try {
        pool(100, [&](size_t i) {
          ++runs;
          if (i == bad || i == bad + 1) throw std::runtime_error("job " + std::to_string(bad));
          rest(std::chrono::microseconds(20));  // so every thread has some
        });
      } catch (const std::runtime_error& error) {
        said = error.what();
      }
      EXPECT_EQ(said, "job " + std::to_string(bad)) << threads;
      if (threads > 1) {
        EXPECT_EQ(runs, 100u);
      }
      expectEveryJobOnce(pool, 20, std::chrono::microseconds(0));
    }
  }
}
