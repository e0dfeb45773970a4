// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <string>

namespace viscera::cli {

/// Shows the progress of long work: the current stage and its percentage in one line of a terminal, nothing if standard
/// error is not a terminal. Also measures the duration of each stage.
class Stages {
 public:
  Stages();
  ~Stages();
  Stages(const Stages&) = delete;
  Stages& operator=(const Stages&) = delete;

  void begin(const std::string& name);
  void at(double share);  ///< progress of the current stage, 0 .. 1
  std::string end();      ///< durations, as in "reading 0.4 s, surfaces 1.2 s"

 private:
  void show(const std::string& text);

  using Clock = std::chrono::steady_clock;
  const bool terminal_;
  std::string name_, took_;
  Clock::time_point began_;
  int shown_percent_ = -1;
};

}  // namespace viscera::cli
