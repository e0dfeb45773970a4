// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "solver/cpu/state/thread_count_tuner.h"

#include <algorithm>
#include <cmath>

namespace viscera {

namespace {

constexpr double kMeasured_s = 0.08;  // length of a measurement: several time slices (4 to 8 ms) of other programs
constexpr int kRounds = 200;          // least number of rounds: covers all kinds of rounds of a tick
constexpr double kBetween_s = 0.4;    // between two measurements
constexpr double kSettle_s = 0.01;    // after a change: threads wake up, or delayed work ends
constexpr double kGain = 1.05;   // least rate over the usual one that counts as faster; measurements differ by less
constexpr double kMargin = 0.1;  // [processors] fewer threads are tried if n bring at most n - 1 plus this
// Time between trials. More threads are tried often, to notice that other programs have ended; fewer are tried rarely.
constexpr double kShortest_s = 1, kLongestMore_s = 4, kLongestFewer_s = 32;

}  // namespace

ThreadCountTuner::ThreadCountTuner(int most)
    : most_(most),
      now_(most),
      usual_(most),
      rates_(static_cast<size_t>(most) + 1),
      fewer_{kLongestFewer_s, kShortest_s},
      more_{kLongestMore_s, kShortest_s} {}

void ThreadCountTuner::took(double at_s, double clock_s, double jobs) {
  if (at_s < settles_s_) return;
  clock_s_ += clock_s;
  jobs_ += jobs;
  ++rounds_;
  if (clock_s_ >= kMeasured_s && rounds_ >= kRounds) decide(at_s);
}

void ThreadCountTuner::worked(double jobs, double work_s) {
  watched_jobs_ += jobs;
  work_s_ += work_s;
}

void ThreadCountTuner::decide(double at_s) {
  rate(now_) = jobs_ / clock_s_;
  brought_ = watched_jobs_ > 0 ? rate(now_) * work_s_ / watched_jobs_ : now_;
  clock_s_ = jobs_ = watched_jobs_ = work_s_ = 0;
  rounds_ = 0;
  if (now_ != usual_) endTrial(at_s);
  const int next = promising(at_s);
  next_s_ = at_s + kBetween_s;
  if (next == now_) return;
  now_ = next;
  settles_s_ = next_s_ = at_s + kSettle_s;
}

void ThreadCountTuner::endTrial(double at_s) {
  const bool helps = rate(now_) > kGain * rate(usual_);
  Trials& same = now_ < usual_ ? fewer_ : more_;
  Trials& other = now_ < usual_ ? more_ : fewer_;
  if (helps) {
    usual_ = now_;
    same.patience_s = other.patience_s = kShortest_s;
    other.next_s = at_s + other.patience_s;  // a change is not undone at once
  } else {
    now_ = usual_;
    settles_s_ = at_s + kSettle_s;
    same.patience_s = std::min(2 * same.patience_s, same.longest_s);
  }
  same.next_s = at_s + same.patience_s;
  tried_s_ = at_s;
}

/// Returns the number to try now, or the present one.
int ThreadCountTuner::promising(double at_s) const {
  const int better = static_cast<int>(std::max_element(rates_.begin(), rates_.end()) - rates_.begin());
  // The rate of the usual number is no longer what it was when it was chosen.
  if (rate(better) > kGain * rate(now_) && at_s >= tried_s_ + kShortest_s) return better;
  const int enough = static_cast<int>(std::ceil(brought_ - kMargin));
  if (enough < now_ && now_ > 1 && at_s >= fewer_.next_s) return std::max(1, enough);
  return now_ < most_ && at_s >= more_.next_s ? now_ + 1 : now_;
}

}  // namespace viscera
