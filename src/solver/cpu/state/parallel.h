// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cstddef>

namespace viscera {

/// Number of items of a range that a thread takes at a time. It begins with the most and decreases towards the end, so
/// that threads end together.
struct Portions {
  size_t least = 1, most = 1;
};

/// Executor of jobs in parallel. parallel(count, job) calls job(0) to job(count - 1) once each, in any order and on any
/// thread, and returns when all are done. Allocates nothing. If jobs throw, one of the exceptions is thrown to the
/// caller when the others are done.
class Parallel {
 public:
  virtual ~Parallel() = default;
  template <class Job>
  void operator()(size_t count, const Job& job) const {
    run(
        count, {},
        [](const void* of, size_t first, size_t end) {
          for (size_t index = first; index < end; ++index) (*static_cast<const Job*>(of))(index);
        },
        &job);
  }
  /// Runs job(first, end) on portions that together cover 0 .. count. Their bounds differ from call to call, so results
  /// must not depend on them.
  template <class Job>
  void ranges(size_t count, Portions portions, const Job& job) const {
    run(
        count, portions, [](const void* of, size_t first, size_t end) { (*static_cast<const Job*>(of))(first, end); },
        &job);
  }
  /// Returns the number of threads that may work at the same time, including the caller's.
  virtual int threads() const { return 1; }

 protected:
  using Call = void (*)(const void* job, size_t first, size_t end);
  virtual void run(size_t count, Portions portions, Call call, const void* job) const = 0;
};

/// Executor of jobs one after the other on the caller's thread.
class Serial : public Parallel {
 protected:
  void run(size_t count, Portions portions, Call call, const void* job) const override {
    for (size_t first = 0; first < count; first += portions.most)
      call(job, first, std::min(count, first + portions.most));
  }
};

}  // namespace viscera
