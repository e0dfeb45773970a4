// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "viscera/solver/cpu/thread_pool.h"

#include <chrono>

#if defined(__x86_64__) || defined(__i386__)
#include <immintrin.h>
#endif

namespace viscera {

namespace {

constexpr int kRoundShift = 32;
constexpr uint64_t kTakenMask = 0xffffffffu;
constexpr std::chrono::microseconds kWatch{50};  // longer than the way from one substep to the next
constexpr int kLooksPerClock = 64;               // the clock is read once in so many looks

void pause() {
#if defined(__x86_64__) || defined(__i386__)
  _mm_pause();
#else
  std::this_thread::yield();
#endif
}

uint64_t roundOf(uint64_t ticket) {
  return ticket >> kRoundShift;
}

}  // namespace

ThreadPool::ThreadPool(int threads) {
  for (int i = 1; i < threads; ++i) workers_.emplace_back([this] { work(); });
}

ThreadPool::~ThreadPool() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    stop_ = true;
  }
  wake_.notify_all();
  for (std::thread& worker : workers_) worker.join();
}

void ThreadPool::run(size_t count, Call call, const void* job) const {
  if (count == 0) return;
  if (workers_.empty() || count == 1) {
    for (size_t index = 0; index < count; ++index) call(job, index);
    return;
  }
  // All jobs of the last round are done. None can be taken of it while the next is made ready.
  const uint64_t round = roundOf(ticket_.load(std::memory_order_relaxed));
  ticket_.store(round << kRoundShift | kTakenMask, std::memory_order_seq_cst);
  call_.store(call, std::memory_order_relaxed);
  job_.store(job, std::memory_order_relaxed);
  count_.store(static_cast<uint32_t>(count), std::memory_order_relaxed);
  done_.store(0, std::memory_order_relaxed);
  ticket_.store((round + 1) << kRoundShift, std::memory_order_seq_cst);
  if (asleep_.load(std::memory_order_seq_cst) > 0) {
    const std::lock_guard<std::mutex> lock(mutex_);
    wake_.notify_all();
  }
  takeJobs();
  for (int looks = 1; done_.load(std::memory_order_acquire) != count; ++looks) {
    // Whoever still has a job may be waiting for this very processor.
    if (looks % (16 * kLooksPerClock) == 0) std::this_thread::yield();
    pause();
  }
}

/// Takes jobs of the current round until none is left. @return whether there was one
bool ThreadPool::takeJobs() const {
  bool any = false;
  uint64_t ticket = ticket_.load(std::memory_order_acquire);
  for (;;) {
    const Call call = call_.load(std::memory_order_relaxed);
    const void* job = job_.load(std::memory_order_relaxed);
    const uint64_t index = ticket & kTakenMask;
    if (index >= count_.load(std::memory_order_relaxed)) return any;
    // Success says that the round is still the one that call, job and count were read in: it cannot end before this
    // job is done.
    if (!ticket_.compare_exchange_weak(ticket, ticket + 1, std::memory_order_acq_rel, std::memory_order_acquire)) {
      continue;
    }
    call(job, static_cast<size_t>(index));
    done_.fetch_add(1, std::memory_order_acq_rel);
    any = true;
    ticket = ticket_.load(std::memory_order_acquire);
  }
}

/// Watches for a round other than this one. @return false if none came for kWatch
bool ThreadPool::watchFor(uint64_t round) const {
  const auto until = std::chrono::steady_clock::now() + kWatch;
  for (int looks = 1;; ++looks) {
    if (roundOf(ticket_.load(std::memory_order_acquire)) != round || stop_) return true;
    if (looks % kLooksPerClock == 0 && std::chrono::steady_clock::now() > until) return false;
    pause();
  }
}

void ThreadPool::work() {
  uint64_t round = 0;
  while (!stop_) {
    if (!watchFor(round)) {
      std::unique_lock<std::mutex> lock(mutex_);
      asleep_.fetch_add(1, std::memory_order_seq_cst);
      wake_.wait(lock, [&] { return stop_ || roundOf(ticket_.load(std::memory_order_seq_cst)) != round; });
      asleep_.fetch_sub(1, std::memory_order_relaxed);
    }
    round = roundOf(ticket_.load(std::memory_order_acquire));
    takeJobs();
  }
}

}  // namespace viscera
