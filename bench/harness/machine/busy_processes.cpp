// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "bench/harness/machine/busy_processes.h"

#include <signal.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "viscera/math/error.h"

namespace viscera::bench {

namespace {

/// Work of a process. It is forked from a program with threads, so it uses system calls only.
[[noreturn]] void compute(const Load& load, pid_t parent) {
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (getppid() != parent) _exit(0);  // the parent has ended concurrently
  if (load.elsewhere) setsid();
  setpriority(PRIO_PROCESS, 0, load.nice);
  for (volatile unsigned count = 0;; count = count + 1) {
  }
}

}  // namespace

BusyProcesses::BusyProcesses(const Load& load) {
  const pid_t parent = getpid();
  for (int i = 0; i < load.processes; ++i) {
    const pid_t process = fork();
    if (process == 0) compute(load, parent);
    if (process < 0) {
      const std::string why = std::strerror(errno);
      end();
      throw Error("cannot start a process that keeps the machine busy: " + why);
    }
    processes_.push_back(process);
  }
}

BusyProcesses::~BusyProcesses() {
  end();
}

void BusyProcesses::end() {
  for (const pid_t process : processes_) kill(process, SIGKILL);
  for (const pid_t process : processes_) waitpid(process, nullptr, 0);
  processes_.clear();
}

}  // namespace viscera::bench
