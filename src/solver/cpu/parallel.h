// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>

namespace viscera {

/// Something that runs jobs side by side. parallel(count, job) calls job(0) to job(count - 1), each once, in any order
/// and on any thread, and returns when all are done. Allocates nothing. What a job throws is thrown to the caller, when
/// the others are done too; of several, one.
class Parallel {
 public:
  virtual ~Parallel() = default;
  template <class Job>
  void operator()(size_t count, const Job& job) const {
    run(
        count, [](const void* of, size_t index) { (*static_cast<const Job*>(of))(index); }, &job);
  }
  /// That may be at work at the same time, the caller's included.
  virtual int threads() const { return 1; }

 protected:
  using Call = void (*)(const void* job, size_t index);
  virtual void run(size_t count, Call call, const void* job) const = 0;
};

/// One after the other, on the caller's thread.
class Serial : public Parallel {
 protected:
  void run(size_t count, Call call, const void* job) const override {
    for (size_t index = 0; index < count; ++index) call(job, index);
  }
};

}  // namespace viscera
