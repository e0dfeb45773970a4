// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <atomic>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

#include "solver/cpu/parallel.h"
#include "viscera/solver/threads.h"

namespace viscera {

/// Threads that share the jobs of a substep with the caller. Each begins with its own run of them, the same in every
/// round of as many jobs, so that what it worked on is still in its cache, and then takes from the others. Between
/// substeps, microseconds apart, they watch for the next; after kWatch without any they sleep and cost nothing. Nobody
/// waits for a thread that the system has put aside before it took a job: jobs are taken one by one by whoever is free.
/// Several solvers may share a pool, on as many threads of their own: their rounds take turns. A job must not begin a
/// round of the same pool.
class ThreadPool : public Parallel {
 public:
  /// @param threads  the caller's included, > 0
  explicit ThreadPool(int threads);
  ~ThreadPool() override;
  ThreadPool(const ThreadPool&) = delete;
  ThreadPool& operator=(const ThreadPool&) = delete;
  int threads() const override { return static_cast<int>(workers_.size()) + 1; }

 protected:
  void run(size_t count, Call call, const void* job) const override;

 private:
  /// Next job of one thread's run, with the round it belongs to in the upper half: one word, so that a job is taken
  /// only of the round whose call, job and count were read. A cache line each.
  struct alignas(64) Ticket {
    std::atomic<uint64_t> next{0};
  };
  void work(size_t thread);
  void takeJobs(size_t thread) const;
  bool takeJob(size_t run) const;
  void doJob(Call call, const void* job, size_t index) const noexcept;
  uint64_t endOf(size_t run, uint64_t count) const;
  bool watchFor(uint64_t round) const;

  mutable std::mutex turn_;  ///< of the round that is under way
  mutable std::atomic<uint64_t> round_{0};
  mutable std::vector<Ticket> tickets_;  ///< [threads]
  mutable std::atomic<uint32_t> count_{0}, done_{0};
  mutable std::atomic<Call> call_{nullptr};
  mutable std::atomic<const void*> job_{nullptr};
  mutable std::atomic<int> asleep_{0};
  mutable std::mutex mutex_;
  mutable std::condition_variable wake_;
  mutable std::exception_ptr error_;  ///< of a job of this round
  std::atomic<bool> stop_{false};
  std::vector<std::thread> workers_;
};

}  // namespace viscera
