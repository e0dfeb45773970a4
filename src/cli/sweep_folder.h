// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>

#include "cli/sweep_plan.h"
#include "cli/sweep_table.h"

namespace viscera::cli {

/// The results of a sweep, shared by any number of processes on machines with a common file system that supports locks:
///   plan.txt             the runs, so that another plan is not mixed in
///   runs/000042/lock     locked while a process, or the session that it started, works on the run
///   runs/000042/result.json, failures.txt   outcome: at most one result, a line per failure
///   results.csv          all of them in one table
/// A killed process leaves a lock without a holder, and no result: the run is repeated.
class SweepFolder {
 public:
  enum class State { kOpen, kDone, kGivenUp };
  /// A run that this process owns while the object exists.
  class Claim {
   public:
    Claim(Claim&& other) noexcept;
    Claim(const Claim&) = delete;
    Claim& operator=(const Claim&) = delete;
    ~Claim();
    int file() const { return file_; }  ///< closed when a program starts; one that inherits it also owns the run

   private:
    friend class SweepFolder;
    explicit Claim(int file) : file_(file) {}
    int file_;
  };

  /// @param tries  failures after which a run is given up, > 0   @throws Error  of another plan, or not writable
  SweepFolder(std::string folder, const SweepPlan& plan, int tries);

  State state(size_t run) const;
  /// Claims a run. @return nothing if it is taken or not open
  std::optional<Claim> claim(size_t run) const;
  std::string runFolder(size_t run) const;  ///< exists after the run was claimed
  void keepResult(size_t run, const std::string& json) const;
  void keepFailure(size_t run, const std::string& line) const;
  void clearFailures() const;  ///< removes the failures of all runs, so that they are tried again
  /// Returns a line per run: its keys, its outcome, and the output of `viscera run`.
  SweepTable table() const;
  void writeTable() const;  ///< writes results.csv

 private:
  std::vector<std::string> failuresOf(size_t run) const;

  std::string folder_;
  const SweepPlan& plan_;
  size_t tries_;
};

}  // namespace viscera::cli
