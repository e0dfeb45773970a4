// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <csignal>
#include <cstddef>
#include <memory>

namespace viscera::nodes {

/// Alternate stack for crash handlers of the thread that creates it: a stack that has overflowed has no room for them.
class CrashStack {
 public:
  CrashStack() : room_(new char[kSize]) {
    stack_t wanted{};
    wanted.ss_sp = room_.get();
    wanted.ss_size = kSize;
    sigaltstack(&wanted, &before_);
  }
  ~CrashStack() { sigaltstack(&before_, nullptr); }
  CrashStack(const CrashStack&) = delete;
  CrashStack& operator=(const CrashStack&) = delete;

  /// Creates one for the calling thread, until that thread ends.
  static void give() { thread_local const CrashStack stack; }

 private:
  static constexpr size_t kSize = 65536;  ///< [bytes]; wide vector registers take about 11 kB, and the handler is small
  const std::unique_ptr<char[]> room_;
  stack_t before_{};
};

}  // namespace viscera::nodes
