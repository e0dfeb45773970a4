// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "solver/cpu/store/helping_threads.h"

#include <algorithm>
#include <cmath>

namespace viscera {

namespace {

constexpr double kMeasured_s = 0.08;  // of rounds: several time slices (4 to 8 ms) of other programs that are there
constexpr int kRounds = 200;          // at least: of all kinds that a tick has
constexpr double kBetween_s = 0.4;    // two measurements
constexpr double kSettle_s = 0.01;    // after a change: threads have to wake, or what they held up has to end
constexpr double kGain = 1.05;        // of a number over the usual one: more than two measurements differ by
constexpr double kMargin = 0.1;       // [processors] that n threads may bring above n - 1, and fewer are still tried
// Between trials. Of more threads often enough to notice that others have gone; of fewer seldom, where all help.
constexpr double kShortest_s = 1, kLongestMore_s = 4, kLongestFewer_s = 32;

}  // namespace

HelpingThreads::HelpingThreads(int most)
    : most_(most),
      now_(most),
      usual_(most),
      rates_(static_cast<size_t>(most) + 1),
      fewer_{kLongestFewer_s, kShortest_s},
      more_{kLongestMore_s, kShortest_s} {}

void HelpingThreads::took(double at_s, double clock_s, double jobs) {
  if (at_s < settles_s_) return;
  clock_s_ += clock_s;
  jobs_ += jobs;
  ++rounds_;
  if (clock_s_ >= kMeasured_s && rounds_ >= kRounds) decide(at_s);
}

void HelpingThreads::worked(double jobs, double work_s) {
  watched_jobs_ += jobs;
  work_s_ += work_s;
}

void HelpingThreads::decide(double at_s) {
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

void HelpingThreads::endTrial(double at_s) {
  const bool helps = rate(now_) > kGain * rate(usual_);
  Trials& same = now_ < usual_ ? fewer_ : more_;
  Trials& other = now_ < usual_ ? more_ : fewer_;
  if (helps) {
    usual_ = now_;
    same.patience_s = other.patience_s = kShortest_s;
    other.next_s = at_s + other.patience_s;  // one is not taken back at once
  } else {
    now_ = usual_;
    settles_s_ = at_s + kSettle_s;
    same.patience_s = std::min(2 * same.patience_s, same.longest_s);
  }
  same.next_s = at_s + same.patience_s;
  tried_s_ = at_s;
}

/// The number to be tried now, or the usual one.
int HelpingThreads::promising(double at_s) const {
  const int better = static_cast<int>(std::max_element(rates_.begin(), rates_.end()) - rates_.begin());
  // The usual one is no longer what it was when it was chosen.
  if (rate(better) > kGain * rate(now_) && at_s >= tried_s_ + kShortest_s) return better;
  const int enough = static_cast<int>(std::ceil(brought_ - kMargin));
  if (enough < now_ && now_ > 1 && at_s >= fewer_.next_s) return std::max(1, enough);
  return now_ < most_ && at_s >= more_.next_s ? now_ + 1 : now_;
}

}  // namespace viscera
