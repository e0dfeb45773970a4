// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <atomic>
#include <condition_variable>
#include <mutex>
#include <thread>
#include <vector>

#include "viscera/solver/cpu/parallel.h"

namespace viscera {

/// Threads that share the jobs of a substep with the caller. Between substeps, microseconds apart, they watch for the
/// next; after kWatch without any they sleep and cost nothing. Nobody waits for a thread that the system has put aside
/// before it took a job: jobs are taken one by one by whoever is free.
class ThreadPool : public Parallel {
 public:
  /// @param threads  the caller's included, > 0
  explicit ThreadPool(int threads);
  ~ThreadPool() override;
  ThreadPool(const ThreadPool&) = delete;
  ThreadPool& operator=(const ThreadPool&) = delete;
  int threads() const { return static_cast<int>(workers_.size()) + 1; }

 protected:
  void run(size_t count, Call call, const void* job) const override;

 private:
  void work();
  bool takeJobs() const;
  bool watchFor(uint64_t round) const;

  // round_ << 32 | jobs taken: one word, so that a job is taken only of the round whose call and job were read.
  mutable std::atomic<uint64_t> ticket_{0};
  mutable std::atomic<uint32_t> count_{0}, done_{0};
  mutable std::atomic<Call> call_{nullptr};
  mutable std::atomic<const void*> job_{nullptr};
  mutable std::atomic<int> asleep_{0};
  mutable std::mutex mutex_;
  mutable std::condition_variable wake_;
  std::atomic<bool> stop_{false};
  std::vector<std::thread> workers_;
};

}  // namespace viscera
