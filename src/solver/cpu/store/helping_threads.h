// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <vector>

namespace viscera {

/// How many threads rounds of jobs are shared by: as many as help. Where other programs want the processors too, a
/// thread that is put aside in the middle of a job holds all others up, and fewer of them get further. So it is
/// measured what threads bring: processor time within jobs, of all of them, over time on the clock. n threads bring n
/// at best; where they bring about what n - 1 could, fewer are tried, and kept where jobs are done faster; where some
/// are left out, more are tried; either after a second, then after twice as long each time that it was in vain. Knows
/// no threads and no clock: it is told.
class HelpingThreads {
 public:
  /// @param most  > 0; that begin
  explicit HelpingThreads(int most);
  int now() const { return now_; }
  /// Are rounds to be measured? Now and then, and as long as one is under way. @param at_s  any clock
  bool due(double at_s) const { return at_s >= next_s_; }
  /// A round that was measured: when it ended, how long it was, and how many jobs it had.
  void took(double at_s, double clock_s, double jobs);
  /// What some of these rounds cost: processor time within their jobs, of all threads.
  void worked(double jobs, double work_s);

 private:
  /// Trials of fewer, or of more threads.
  struct Trials {
    double longest_s, patience_s;  ///< from one to the next, at most and now
    double next_s = 0;             ///< the earliest time
  };
  void decide(double at_s);
  void endTrial(double at_s);
  int promising(double at_s) const;
  double& rate(int threads) { return rates_[static_cast<size_t>(threads)]; }
  double rate(int threads) const { return rates_[static_cast<size_t>(threads)]; }

  int most_, now_;
  int usual_;                  ///< while another number is tried: the one before; else now_
  std::vector<double> rates_;  ///< [threads] jobs per second on the clock, newest; 0: never measured
  double brought_ = 0;         ///< by those of now, newest
  // Of this measurement so far:
  double clock_s_ = 0, jobs_ = 0;
  double watched_jobs_ = 0, work_s_ = 0;  ///< of the rounds whose processor time was measured
  int rounds_ = 0;

  double settles_s_ = 0;  ///< until this time rounds do not count: the number has just changed
  double next_s_ = 0;     ///< when rounds are measured again
  double tried_s_ = 0;    ///< end of the last trial
  Trials fewer_, more_;
};

}  // namespace viscera
