// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <atomic>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

#include "solver/cpu/state/parallel.h"
#include "solver/cpu/state/thread_count_tuner.h"
#include "viscera/solver/threads.h"

namespace viscera {

/// Threads that share the jobs of a substep with the caller.
///
/// Each begins with its own run of jobs, the same in every round with as many jobs, so that its data is still in its
/// cache. Then it takes jobs from the others, fewer at a time towards the end. Between substeps, microseconds apart,
/// threads poll for the next; after kWatch without any they sleep and cost nothing. A round does not wait for a thread
/// that was preempted before it took a job: the others take its jobs. If preemption is so frequent that fewer threads
/// are faster, some are left out for a while (thread_count_tuner.h). The caller polls for the end of the last jobs for
/// a short time, then it sleeps too: yielding would give a time slice to any other program, whatever its priority.
///
/// Several solvers may share a pool, each with its own calling thread: their rounds take turns. A job must not begin a
/// round of the same pool.
class ThreadPool : public Parallel {
 public:
  /// @param threads  including the caller's, > 0
  explicit ThreadPool(int threads);
  ~ThreadPool() override;
  ThreadPool(const ThreadPool&) = delete;
  ThreadPool& operator=(const ThreadPool&) = delete;
  int threads() const override { return static_cast<int>(workers_.size()) + 1; }
  /// Limits the threads that share the jobs from the next round on, including the caller's, > 0. Any thread may call
  /// it.
  void limit(int threads) { limit_.store(threads, std::memory_order_relaxed); }
  /// Returns the number of threads assigned to the last round.
  int sharing() const { return static_cast<int>(sharing_.load(std::memory_order_relaxed)); }

 protected:
  void run(size_t count, Portions portions, Call call, const void* job) const override;

 private:
  /// The jobs of a round and how to share them.
  struct Round {
    Call call = nullptr;
    const void* job = nullptr;
    size_t count = 0, least = 1, most = 1;
    size_t sharing = 1;  ///< number of threads
  };
  /// The same for other threads to read. A job is taken only from the round in which these were read (Ticket).
  struct SharedRound {
    std::atomic<Call> call{nullptr};
    std::atomic<const void*> job{nullptr};
    std::atomic<size_t> count{0}, least{1}, most{1}, sharing{1};
  };
  /// Next job of one thread's run, with its round in the upper half. As one word, so that a job is taken only from the
  /// round of the call, job and count that were read. One cache line each.
  struct alignas(64) Ticket {
    std::atomic<uint64_t> next{0};
    std::atomic<uint64_t> work_ns{0};  ///< processor time within jobs of watched rounds
  };
  void work(size_t thread);
  void begin(const Round& round) const;
  void setSharing(size_t threads) const;
  void doAlone(const Round& round) const;
  void share(const Round& round) const;
  void shareTimed(const Round& round) const;
  void takeJobs(size_t thread) const;
  bool takeJob(size_t run) const;
  void doJobs(Call call, const void* job, size_t first, size_t end) const noexcept;
  void sleep(size_t thread, uint64_t round);
  uint64_t workDone() const;

  mutable std::mutex turn_;  ///< held during a round
  mutable std::atomic<uint64_t> round_{0};
  mutable std::vector<Ticket> tickets_;  ///< [threads]
  mutable SharedRound shared_;
  mutable std::atomic<size_t> done_{0};
  mutable std::atomic<bool> caller_asleep_{false}, watched_{false};
  mutable std::atomic<int> asleep_{0};
  mutable std::mutex mutex_;
  mutable std::condition_variable wake_, ended_, wanted_;
  mutable std::exception_ptr error_;  ///< of a job of this round
  std::atomic<bool> stop_{false};
  std::atomic<int> limit_;
  mutable std::atomic<size_t> sharing_;
  mutable ThreadCountTuner helping_;
  mutable bool timed_ = false;
  mutable int until_check_ = 1;  ///< rounds until the pool checks whether to time rounds, or watches a timed one
  std::vector<std::thread> workers_;
};

}  // namespace viscera
