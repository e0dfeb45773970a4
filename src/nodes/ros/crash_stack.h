// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <csignal>
#include <cstddef>
#include <memory>

namespace viscera::nodes {

/// Where handlers of crashes run in the thread that makes it, for as long as that lives: a stack that has overflowed
/// has no room for them.
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

  /// One for the calling thread, until it ends.
  static void give() { thread_local const CrashStack stack; }

 private:
  static constexpr size_t kSize = 65536;  ///< the registers of wide vectors, some 11 kB, and a small handler
  const std::unique_ptr<char[]> room_;
  stack_t before_{};
};

}  // namespace viscera::nodes
