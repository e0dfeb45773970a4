// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <string>

namespace viscera::cli {

/// Stages of long work: the present one and how far it is, in one line of a terminal, nothing where standard error is
/// no terminal; and how long each took.
class Stages {
 public:
  Stages();
  ~Stages();
  Stages(const Stages&) = delete;
  Stages& operator=(const Stages&) = delete;

  void begin(const std::string& name);
  void at(double share);  ///< of the present stage, 0 .. 1
  std::string end();      ///< as in "reading 0.4 s, surfaces 1.2 s"

 private:
  void show(const std::string& text);

  using Clock = std::chrono::steady_clock;
  const bool terminal_;
  std::string name_, took_;
  Clock::time_point began_;
  int shown_percent_ = -1;
};

}  // namespace viscera::cli
