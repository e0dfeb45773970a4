// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <atomic>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

#include "solver/cpu/store/helping_threads.h"
#include "solver/cpu/store/parallel.h"
#include "viscera/solver/threads.h"

namespace viscera {

/// Threads that share the jobs of a substep with the caller. Each begins with its own run of them, the same in every
/// round of as many jobs, so that what it worked on is still in its cache, and then takes from the others; fewer at a
/// time towards the end. Between substeps, microseconds apart, they watch for the next; after kWatch without any they
/// sleep and cost nothing. A round does not wait for a thread that the system has put aside before it took a job: the
/// others take them. Where threads are put aside so often that fewer get further, some are left out for a while
/// (helping_threads.h). The caller watches for the end of the last jobs for a short time, then it sleeps too: a thread
/// that yields gives a time slice to whatever else is there, of any priority.
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
  /// From the next round on no more than so many share the jobs, the caller's included, > 0. From any thread.
  void limit(int threads) { limit_.store(threads, std::memory_order_relaxed); }
  /// That shared the jobs of the last round, or were meant to.
  int sharing() const { return static_cast<int>(sharing_.load(std::memory_order_relaxed)); }

 protected:
  void run(size_t count, Portions portions, Call call, const void* job) const override;

 private:
  /// What a round is.
  struct Round {
    Call call = nullptr;
    const void* job = nullptr;
    size_t count = 0, least = 1, most = 1;
    size_t sharing = 1;  ///< threads
  };
  /// The same where other threads read it: a job is taken only of the round that it was read in (Ticket).
  struct SharedRound {
    std::atomic<Call> call{nullptr};
    std::atomic<const void*> job{nullptr};
    std::atomic<size_t> count{0}, least{1}, most{1}, sharing{1};
  };
  /// Next job of one thread's run, with the round it belongs to in the upper half: one word, so that a job is taken
  /// only of the round whose call, job and count were read. A cache line each.
  struct alignas(64) Ticket {
    std::atomic<uint64_t> next{0};
    std::atomic<uint64_t> work_ns{0};  ///< processor time within jobs, in rounds that are watched
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

  mutable std::mutex turn_;  ///< of the round that is under way
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
  mutable HelpingThreads helping_;
  mutable bool timed_ = false;
  mutable int until_look_ = 1;  ///< rounds: then it is asked whether they are to be timed, or one of those is watched
  std::vector<std::thread> workers_;
};

}  // namespace viscera
