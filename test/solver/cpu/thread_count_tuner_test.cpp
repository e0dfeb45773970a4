// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "solver/cpu/state/thread_count_tuner.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>

namespace viscera {
namespace {

constexpr double kRound_s = 1e-4, kJob_s = 1e-5;

/// A simulated machine that measures rounds wherever ThreadCountTuner requests it, on a clock of its own.
class Machine {
 public:
  /// @param brings  jobs done by a number of threads in the time in which a single one does one
  explicit Machine(int threads, std::function<double(int)> brings) : helping(threads), brings_(std::move(brings)) {}
  void becomes(std::function<double(int)> brings) { brings_ = std::move(brings); }
  /// @return share of the time in which a number of threads worked
  double shareOf(int threads, double seconds) {
    double with_s = 0;
    for (const double end_s = now_s_ + seconds; now_s_ < end_s; now_s_ += kRound_s) {
      if (helping.now() == threads) with_s += kRound_s;
      if (!helping.due(now_s_)) continue;
      const double jobs = brings_(helping.now()) * kRound_s / kJob_s;
      helping.worked(jobs, jobs * kJob_s);
      helping.took(now_s_ + kRound_s, kRound_s, jobs);
    }
    return with_s / seconds;
  }
  ThreadCountTuner helping;

 private:
  std::function<double(int)> brings_;
  double now_s_ = 1000;
};

double idle(int threads) {
  return 0.95 * threads;
}
/// Two threads that stall each other on two processors, one of which another program uses.
double stalled(int threads) {
  return threads == 1 ? 1.0 : 0.8;
}

}  // namespace

TEST(ThreadCountTuner, AllHelpOnAnIdleMachine) {
  for (const int threads : {1, 2, 4, 16}) {
    Machine machine(threads, idle);
    EXPECT_GT(machine.shareOf(threads, 60), 0.999) << threads;
  }
}

TEST(ThreadCountTuner, LeavesOutTheOneThatHoldsUpAndTriesItNowAndThen) {
  Machine machine(2, stalled);
  machine.shareOf(1, 1);
  EXPECT_EQ(machine.helping.now(), 1);
  const double tried = machine.shareOf(2, 60);
  EXPECT_GT(tried, 0);
  EXPECT_LT(tried, 0.05);  // 0.1 s in 4
}

TEST(ThreadCountTuner, TakesItBackWithinSecondsWhenTheOtherProgramHasEnded) {
  Machine machine(2, stalled);
  machine.shareOf(1, 60);
  machine.becomes(idle);
  machine.shareOf(2, 6);
  EXPECT_GT(machine.shareOf(2, 10), 0.999);
}

TEST(ThreadCountTuner, KeepsAThreadThatHelpsALittle) {
  Machine machine(2, [](int threads) { return threads == 1 ? 0.6 : 0.9; });
  EXPECT_GT(machine.shareOf(2, 120), 0.98);
}

TEST(ThreadCountTuner, FindsTheNumberThatGetsFarthest) {
  // Eight processors, three of them in use: more than five threads wait for their turn.
  Machine machine(8, [](int threads) { return threads <= 5 ? 0.95 * threads : 3.0 - 0.1 * threads; });
  machine.shareOf(5, 20);
  EXPECT_GT(machine.shareOf(5, 60), 0.9);
}

TEST(ThreadCountTuner, FollowsALoadThatComesAndGoes) {
  Machine machine(2, idle);
  machine.shareOf(2, 10);
  for (int i = 0; i < 5; ++i) {
    machine.becomes(stalled);
    machine.shareOf(1, 8);
    EXPECT_GT(machine.shareOf(1, 4), 0.9) << i;
    machine.becomes(idle);
    machine.shareOf(2, 8);
    EXPECT_GT(machine.shareOf(2, 4), 0.9) << i;
  }
}

}  // namespace viscera
