// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cstddef>

namespace viscera {

/// Of a range that is worked through in parts: how many items a thread takes at a time. It begins with the most, and
/// takes fewer the nearer the end is, so that threads end together.
struct Portions {
  size_t least = 1, most = 1;
};

/// Something that runs jobs side by side. parallel(count, job) calls job(0) to job(count - 1), each once, in any order
/// and on any thread, and returns when all are done. Allocates nothing. What a job throws is thrown to the caller, when
/// the others are done too; of several, one.
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
  /// The same for job(first, end): parts of 0 .. count that together are all of it. Where they begin and end differs
  /// from one time to the next, so that results must not depend on it.
  template <class Job>
  void ranges(size_t count, Portions portions, const Job& job) const {
    run(
        count, portions, [](const void* of, size_t first, size_t end) { (*static_cast<const Job*>(of))(first, end); },
        &job);
  }
  /// That may be at work at the same time, the caller's included.
  virtual int threads() const { return 1; }

 protected:
  using Call = void (*)(const void* job, size_t first, size_t end);
  virtual void run(size_t count, Portions portions, Call call, const void* job) const = 0;
};

/// One after the other, on the caller's thread.
class Serial : public Parallel {
 protected:
  void run(size_t count, Portions portions, Call call, const void* job) const override {
    for (size_t first = 0; first < count; first += portions.most)
      call(job, first, std::min(count, first + portions.most));
  }
};

}  // namespace viscera
