// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "cli/import/stages.h"

#include <unistd.h>

#include <iostream>

#include "math/number_text.h"

namespace viscera::cli {

Stages::Stages() : terminal_(isatty(STDERR_FILENO) != 0) {}

Stages::~Stages() {
  show("");
}

void Stages::show(const std::string& text) {
  constexpr const char* kClearLine = "\r\x1b[K";
  if (terminal_) std::cerr << kClearLine << text << std::flush;
}

void Stages::begin(const std::string& name) {
  end();
  name_ = name;
  began_ = Clock::now();
  shown_percent_ = -1;
  show(name + " ...");
}

void Stages::at(double share) {
  const int percent = static_cast<int>(100 * share);
  if (percent != shown_percent_) show(name_ + " " + std::to_string(percent) + " %");
  shown_percent_ = percent;
}

std::string Stages::end() {
  if (!name_.empty()) {
    TextOut text;
    text.precision(1);
    text << std::fixed << (took_.empty() ? "" : ", ") << name_ << ' '
         << std::chrono::duration<double>(Clock::now() - began_).count() << " s";
    took_ += text.str();
  }
  name_.clear();
  show("");
  return took_;
}

}  // namespace viscera::cli
