// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>

#include "cli/sweep_plan.h"
#include "cli/sweep_table.h"

namespace viscera::cli {

/// Where a sweep's results are, shared by any number of processes on machines that see one file system with locks:
///   plan.txt             the runs, so that another plan is not mixed in
///   runs/000042/lock     locked while a process, or the session that it started, works on the run
///   runs/000042/result.json, failures.txt   how it ended: at most one result, a line per failure
///   results.csv          all of them in one table
/// What a process leaves behind that is killed is a lock without a holder, and no result: the run is done again.
class SweepFolder {
 public:
  enum class State { kOpen, kDone, kGivenUp };
  /// A run that is this process's while it lives.
  class Claim {
   public:
    Claim(Claim&& other) noexcept;
    Claim(const Claim&) = delete;
    Claim& operator=(const Claim&) = delete;
    ~Claim();
    int file() const { return file_; }  ///< closed when a program is started; one that inherits it holds the run too

   private:
    friend class SweepFolder;
    explicit Claim(int file) : file_(file) {}
    int file_;
  };

  /// @param tries  failures after which a run is given up, > 0   @throws Error  another plan's, or not to be written
  SweepFolder(std::string folder, const SweepPlan& plan, int tries);

  State state(size_t run) const;
  /// @return nothing if it is taken or it is not open
  std::optional<Claim> claim(size_t run) const;
  std::string runFolder(size_t run) const;  ///< there once the run was claimed
  void keepResult(size_t run, const std::string& json) const;
  void keepFailure(size_t run, const std::string& line) const;
  void forgetFailures() const;  ///< of all runs: they are tried again
  /// A line per run: its keys, how it ended, and what `viscera run` said of it.
  SweepTable table() const;
  void writeTable() const;  ///< to results.csv

 private:
  std::vector<std::string> failuresOf(size_t run) const;

  std::string folder_;
  const SweepPlan& plan_;
  size_t tries_;
};

}  // namespace viscera::cli
