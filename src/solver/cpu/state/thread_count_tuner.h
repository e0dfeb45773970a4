// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <vector>

namespace viscera {

/// Tuner of the number of threads that share rounds of jobs. If other programs need the processors too, a thread that
/// is preempted in the middle of a job delays all others, and fewer threads are faster. The measure is processor time
/// within jobs, over all threads, divided by elapsed time: at best n for n threads. If n threads achieve no more than
/// about n - 1, fewer are tried, and kept if jobs are done faster. If some threads are left out, more are tried. Either
/// trial comes after one second, then after twice the time for each trial in vain. The class has no threads and no
/// clock; its caller passes in all measurements.
class ThreadCountTuner {
 public:
  /// @param most  number of threads, > 0; begins with it
  explicit ThreadCountTuner(int most);
  int now() const { return now_; }
  /// Returns whether to measure rounds now: periodically, and until a measurement is complete.
  /// @param at_s  any clock
  bool due(double at_s) const { return at_s >= next_s_; }
  /// Records a measured round: when it ended, how long it took, and how many jobs it had.
  void took(double at_s, double clock_s, double jobs);
  /// Records the cost of some of these rounds: processor time within their jobs, over all threads.
  void worked(double jobs, double work_s);

 private:
  /// Trials of fewer, or of more threads.
  struct Trials {
    double longest_s, patience_s;  ///< time between trials, at most and now
    double next_s = 0;             ///< earliest time of the next trial
  };
  void decide(double at_s);
  void endTrial(double at_s);
  int promising(double at_s) const;
  double& rate(int threads) { return rates_[static_cast<size_t>(threads)]; }
  double rate(int threads) const { return rates_[static_cast<size_t>(threads)]; }

  int most_, now_;
  int usual_;                  ///< number before the trial during a trial; otherwise now_
  std::vector<double> rates_;  ///< [threads] latest rate, jobs per elapsed second; 0: never measured
  double brought_ = 0;         ///< latest processor time over elapsed time, with now_ threads
  // Sums of the current measurement:
  double clock_s_ = 0, jobs_ = 0;
  double watched_jobs_ = 0, work_s_ = 0;  ///< of the rounds with measured processor time
  int rounds_ = 0;

  double settles_s_ = 0;  ///< rounds do not count until this time, as the number has just changed
  double next_s_ = 0;     ///< when rounds are measured next
  double tried_s_ = 0;    ///< end of the last trial
  Trials fewer_, more_;
};

}  // namespace viscera
