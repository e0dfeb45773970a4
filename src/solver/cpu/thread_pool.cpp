// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "solver/cpu/thread_pool.h"

#include <algorithm>
#include <chrono>
#include <utility>

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

}  // namespace

std::shared_ptr<ThreadPool> makeThreadPool(int threads) {
  const auto there = static_cast<int>(std::thread::hardware_concurrency());
  return std::make_shared<ThreadPool>(std::max(1, threads > 0 ? threads : there));
}

ThreadPool::ThreadPool(int threads) : tickets_(static_cast<size_t>(threads)) {
  for (size_t i = 1; i < tickets_.size(); ++i) workers_.emplace_back([this, i] { work(i); });
}

ThreadPool::~ThreadPool() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    stop_ = true;
  }
  wake_.notify_all();
  for (std::thread& worker : workers_) worker.join();
}

/// Jobs of run r are those from the end of run r - 1 to its own.
uint64_t ThreadPool::endOf(size_t run, uint64_t count) const {
  return (run + 1) * count / tickets_.size();
}

void ThreadPool::run(size_t count, Call call, const void* job) const {
  if (count == 0) return;
  if (workers_.empty() || count == 1) {
    for (size_t index = 0; index < count; ++index) call(job, index);
    return;
  }
  const std::lock_guard<std::mutex> turn(turn_);
  // All jobs of the last round are done. None can be taken of it while the next is made ready.
  const uint64_t round = round_.load(std::memory_order_relaxed);
  for (Ticket& ticket : tickets_) ticket.next.store(round << kRoundShift | kTakenMask, std::memory_order_seq_cst);
  call_.store(call, std::memory_order_relaxed);
  job_.store(job, std::memory_order_relaxed);
  count_.store(static_cast<uint32_t>(count), std::memory_order_relaxed);
  done_.store(0, std::memory_order_relaxed);
  for (size_t r = 0; r < tickets_.size(); ++r) {
    const uint64_t first = r == 0 ? 0 : endOf(r - 1, count);
    tickets_[r].next.store((round + 1) << kRoundShift | first, std::memory_order_release);
  }
  round_.store(round + 1, std::memory_order_seq_cst);
  if (asleep_.load(std::memory_order_seq_cst) > 0) {
    const std::lock_guard<std::mutex> lock(mutex_);
    wake_.notify_all();
  }
  takeJobs(0);
  for (int looks = 1; done_.load(std::memory_order_acquire) != count; ++looks) {
    // Whoever still has a job may be waiting for this very processor.
    if (looks % (16 * kLooksPerClock) == 0) std::this_thread::yield();
    pause();
  }
  if (error_) std::rethrow_exception(std::exchange(error_, nullptr));
}

/// Takes jobs until none is left, of a thread's own run first.
void ThreadPool::takeJobs(size_t thread) const {
  for (size_t i = 0; i < tickets_.size(); ++i) {
    while (takeJob((thread + i) % tickets_.size())) {
    }
  }
}

/// What a job throws is kept for the thread that steps; of several, the first.
void ThreadPool::doJob(Call call, const void* job, size_t index) const noexcept {
  try {
    call(job, index);
  } catch (...) {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (!error_) error_ = std::current_exception();
  }
}

/// Takes the next job of a run and does it. @return false if none is left
bool ThreadPool::takeJob(size_t run) const {
  std::atomic<uint64_t>& next = tickets_[run].next;
  uint64_t ticket = next.load(std::memory_order_acquire);
  for (;;) {
    const Call call = call_.load(std::memory_order_relaxed);
    const void* job = job_.load(std::memory_order_relaxed);
    const uint64_t index = ticket & kTakenMask;
    if (index >= endOf(run, count_.load(std::memory_order_relaxed))) return false;
    // Success says that the round is still the one that call, job and count were read in: it cannot end before this
    // job is done.
    if (!next.compare_exchange_weak(ticket, ticket + 1, std::memory_order_acq_rel, std::memory_order_acquire)) continue;
    doJob(call, job, static_cast<size_t>(index));
    done_.fetch_add(1, std::memory_order_acq_rel);
    return true;
  }
}

/// Watches for a round other than this one. @return false if none came for kWatch
bool ThreadPool::watchFor(uint64_t round) const {
  const auto until = std::chrono::steady_clock::now() + kWatch;
  for (int looks = 1;; ++looks) {
    if (round_.load(std::memory_order_acquire) != round || stop_) return true;
    if (looks % kLooksPerClock == 0 && std::chrono::steady_clock::now() > until) return false;
    pause();
  }
}

void ThreadPool::work(size_t thread) {
  uint64_t round = 0;
  while (!stop_) {
    if (!watchFor(round)) {
      std::unique_lock<std::mutex> lock(mutex_);
      asleep_.fetch_add(1, std::memory_order_seq_cst);
      wake_.wait(lock, [&] { return stop_ || round_.load(std::memory_order_seq_cst) != round; });
      asleep_.fetch_sub(1, std::memory_order_relaxed);
    }
    round = round_.load(std::memory_order_acquire);
    takeJobs(thread);
  }
}

}  // namespace viscera
