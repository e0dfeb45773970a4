// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <sys/types.h>

#include <string>
#include <vector>

namespace viscera::bench {

/// Other processes that use the CPU.
struct Load {
  std::string name;
  int processes = 0, nice = 0;
  bool elsewhere = false;  ///< whether each has a session of its own, like one started in another terminal
};

/// Processes that compute without waiting, from the constructor to the destructor, or to this process's end.
class BusyProcesses {
 public:
  /// @throws Error  the system cannot create more processes
  explicit BusyProcesses(const Load& load);
  ~BusyProcesses();
  BusyProcesses(const BusyProcesses&) = delete;
  BusyProcesses& operator=(const BusyProcesses&) = delete;

 private:
  void end();
  std::vector<pid_t> processes_;
};

}  // namespace viscera::bench
