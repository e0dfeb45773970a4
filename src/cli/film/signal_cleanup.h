// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <sys/types.h>

#include <array>
#include <csignal>
#include <string>

namespace viscera::cli {

/// While it exists, a signal that ends the program, such as Ctrl-C, first ends a child process and removes its file.
/// There is one object at a time.
class SignalCleanup {
 public:
  /// @param file  file to remove
  explicit SignalCleanup(const std::string& file);
  ~SignalCleanup();
  SignalCleanup(const SignalCleanup&) = delete;
  SignalCleanup& operator=(const SignalCleanup&) = delete;

  /// Sets the child process that writes the file.
  void setProcess(pid_t process);

 private:
  static constexpr std::array<int, 3> kSignals = {SIGINT, SIGTERM, SIGHUP};
  std::array<struct sigaction, 3> before_{};
};

}  // namespace viscera::cli
