// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "cli/film/signal_cleanup.h"

#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <climits>
#include <cstring>

namespace viscera::cli {

namespace {

// What the handler uses. It may only make system calls that are safe in a signal handler.
char file_to_remove[PATH_MAX];
std::atomic<pid_t> process_to_end{-1};
static_assert(std::atomic<pid_t>::is_always_lock_free);

void cleanUp(int number) {
  const pid_t process = process_to_end;
  if (process > 0) {
    kill(process, SIGKILL);
    waitpid(process, nullptr, 0);  // because it may be about to create the file
  }
  unlink(file_to_remove);
  signal(number, SIG_DFL);
  raise(number);
}

}  // namespace

SignalCleanup::SignalCleanup(const std::string& file) {
  if (file.size() >= sizeof file_to_remove) return;  // no such path can be opened
  std::strcpy(file_to_remove, file.c_str());
  for (size_t s = 0; s < kSignals.size(); ++s) {
    sigaction(kSignals[s], nullptr, &before_[s]);
    if (before_[s].sa_handler == SIG_IGN) continue;  // as under nohup
    struct sigaction action = {};
    action.sa_handler = cleanUp;
    sigfillset(&action.sa_mask);
    sigaction(kSignals[s], &action, nullptr);
  }
}

SignalCleanup::~SignalCleanup() {
  for (size_t s = 0; s < kSignals.size(); ++s) sigaction(kSignals[s], &before_[s], nullptr);
  process_to_end = -1;
}

void SignalCleanup::setProcess(pid_t process) {
  process_to_end = process;
}

}  // namespace viscera::cli
