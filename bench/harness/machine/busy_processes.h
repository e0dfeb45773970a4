// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <sys/types.h>

#include <string>
#include <vector>

namespace viscera::bench {

/// What else wants the processors.
struct Load {
  std::string name;
  int processes = 0, nice = 0;
  bool elsewhere = false;  ///< each in a session of its own, as one that was started in another terminal
};

/// Processes that compute and never wait, from the constructor to the destructor, or to this process's end.
class BusyProcesses {
 public:
  /// @throws Error  the system makes no more processes
  explicit BusyProcesses(const Load& load);
  ~BusyProcesses();
  BusyProcesses(const BusyProcesses&) = delete;
  BusyProcesses& operator=(const BusyProcesses&) = delete;

 private:
  void end();
  std::vector<pid_t> processes_;
};

}  // namespace viscera::bench
