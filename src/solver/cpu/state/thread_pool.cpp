// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "solver/cpu/state/thread_pool.h"

#include <time.h>

#include <algorithm>
#include <chrono>
#include <utility>

#include "math/processors.h"

#if defined(__x86_64__) || defined(__i386__)
#include <immintrin.h>
#endif

namespace viscera {

namespace {

using Clock = std::chrono::steady_clock;

constexpr int kRoundShift = 32;
constexpr uint64_t kTakenMask = 0xffffffffu;
// Longer than the time between substeps or ticks: the processor of a sleeping thread may be taken by others.
constexpr std::chrono::microseconds kWatch{300};
constexpr std::chrono::microseconds kWatchEnd{50};  // longer than the last jobs of a round, if no thread is preempted
constexpr int kChecksPerClock = 64;                 // the clock is read once in so many polls
constexpr size_t kPartsLeft = 4;                    // a thread takes one of so many parts of the rest of a run
constexpr int kRoundsPerCheck = 17;  // rounds between readings of the clock and of processor times (1 us)

void pause() {
#if defined(__x86_64__) || defined(__i386__)
  _mm_pause();
#else
  std::this_thread::yield();
#endif
}

/// Polls a condition.
/// @return false if it stayed false for all of `patience`
template <class Condition>
bool watch(std::chrono::microseconds patience, const Condition& condition) {
  const auto until = Clock::now() + patience;
  for (int rounds = 1;; ++rounds) {
    if (condition()) return true;
    if (rounds % kChecksPerClock == 0 && Clock::now() > until) return false;
    pause();
  }
}

double secondsNow() {
  return std::chrono::duration<double>(Clock::now().time_since_epoch()).count();
}

/// Returns the processor time of this thread.
uint64_t threadTime_ns() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<uint64_t>(now.tv_sec) * 1000000000u + static_cast<uint64_t>(now.tv_nsec);
}

/// Returns the end of a run of jobs, which begins at the end of the run before it.
uint64_t endOf(size_t run, size_t sharing, uint64_t count) {
  return (run + 1) * count / sharing;
}

}  // namespace

std::shared_ptr<ThreadPool> makeThreadPool(int threads) {
  return std::make_shared<ThreadPool>(threads > 0 ? threads : usableProcessors());
}

ThreadPool::ThreadPool(int threads)
    : tickets_(static_cast<size_t>(threads)), limit_(threads), sharing_(tickets_.size()), helping_(threads) {
  for (size_t i = 1; i < tickets_.size(); ++i) workers_.emplace_back([this, i] { work(i); });
}

ThreadPool::~ThreadPool() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    stop_ = true;
  }
  wake_.notify_all();
  wanted_.notify_all();
  for (std::thread& worker : workers_) worker.join();
}

void ThreadPool::run(size_t count, Portions portions, Call call, const void* job) const {
  if (count == 0) return;
  if (workers_.empty() || count <= portions.least) {
    for (size_t first = 0; first < count; first += portions.most)
      call(job, first, std::min(count, first + portions.most));
    return;
  }
  const std::lock_guard<std::mutex> turn(turn_);
  const int limit = limit_.load(std::memory_order_relaxed);
  Round round{call, job, count, portions.least, portions.most, 1};
  round.sharing = static_cast<size_t>(std::clamp(helping_.now(), 1, std::max(1, limit)));
  if (!timed_ && --until_check_ == 0) {
    until_check_ = kRoundsPerCheck;
    timed_ = limit >= helping_.now() && helping_.due(secondsNow());
  }
  timed_ ? shareTimed(round) : share(round);
  if (error_) std::rethrow_exception(std::exchange(error_, nullptr));
}

void ThreadPool::shareTimed(const Round& round) const {
  const bool watched = --until_check_ == 0;
  const uint64_t before_ns = watched ? workDone() : 0;
  watched_.store(watched, std::memory_order_relaxed);
  const double begin_s = secondsNow();
  share(round);
  const double end_s = secondsNow();
  if (watched) {
    watched_.store(false, std::memory_order_relaxed);
    helping_.worked(static_cast<double>(round.count), 1e-9 * static_cast<double>(workDone() - before_ns));
    until_check_ = kRoundsPerCheck;
  }
  helping_.took(end_s, end_s - begin_s, static_cast<double>(round.count));
  timed_ = helping_.due(end_s);
  if (!timed_) until_check_ = kRoundsPerCheck;
}

/// Returns the processor time within jobs, over all threads and all watched rounds.
uint64_t ThreadPool::workDone() const {
  uint64_t sum_ns = 0;
  for (const Ticket& ticket : tickets_) sum_ns += ticket.work_ns.load(std::memory_order_relaxed);
  return sum_ns;
}

/// Runs a round, from its first job to its last.
void ThreadPool::share(const Round& round) const {
  setSharing(round.sharing);
  if (round.sharing == 1) return doAlone(round);
  begin(round);
  takeJobs(0);
  const auto ended = [&] { return done_.load(std::memory_order_seq_cst) == round.count; };
  if (ended() || watch(kWatchEnd, ended)) return;
  std::unique_lock<std::mutex> lock(mutex_);
  caller_asleep_.store(true, std::memory_order_seq_cst);
  ended_.wait(lock, ended);
  caller_asleep_.store(false, std::memory_order_relaxed);
}

/// Sets the number of threads that share rounds; the others sleep.
void ThreadPool::setSharing(size_t threads) const {
  if (sharing_.load(std::memory_order_relaxed) == threads) return;
  const std::lock_guard<std::mutex> lock(mutex_);
  sharing_.store(threads, std::memory_order_relaxed);
  wanted_.notify_all();
}

void ThreadPool::doAlone(const Round& round) const {
  for (size_t first = 0; first < round.count; first += round.most)
    doJobs(round.call, round.job, first, std::min(round.count, first + round.most));
}

void ThreadPool::begin(const Round& round) const {
  // All jobs of the last round are done, and none of it can be taken while the next round is prepared. Threads that
  // read any of the values stored below also see the tickets as taken, even on processors that reorder stores.
  const uint64_t number = round_.load(std::memory_order_relaxed);
  for (Ticket& ticket : tickets_) ticket.next.store(number << kRoundShift | kTakenMask, std::memory_order_seq_cst);
  shared_.call.store(round.call, std::memory_order_release);
  shared_.job.store(round.job, std::memory_order_release);
  shared_.count.store(round.count, std::memory_order_release);
  shared_.least.store(round.least, std::memory_order_release);
  shared_.most.store(round.most, std::memory_order_release);
  shared_.sharing.store(round.sharing, std::memory_order_release);
  done_.store(0, std::memory_order_relaxed);
  for (size_t r = 0; r < round.sharing; ++r) {
    const uint64_t first = r == 0 ? 0 : endOf(r - 1, round.sharing, round.count);
    tickets_[r].next.store((number + 1) << kRoundShift | first, std::memory_order_release);
  }
  round_.store(number + 1, std::memory_order_seq_cst);
  if (asleep_.load(std::memory_order_seq_cst) > 0) {
    const std::lock_guard<std::mutex> lock(mutex_);
    wake_.notify_all();
  }
}

/// Takes jobs until none is left, first from the thread's own run.
void ThreadPool::takeJobs(size_t thread) const {
  const bool watched = watched_.load(std::memory_order_relaxed);
  const uint64_t before_ns = watched ? threadTime_ns() : 0;
  const size_t sharing = shared_.sharing.load(std::memory_order_relaxed);
  for (size_t i = 0; i < sharing; ++i) {
    while (takeJob((thread + i) % sharing)) {
    }
  }
  if (watched) tickets_[thread].work_ns.fetch_add(threadTime_ns() - before_ns, std::memory_order_relaxed);
}

/// Runs jobs and keeps the first exception for the calling thread.
void ThreadPool::doJobs(Call call, const void* job, size_t first, size_t end) const noexcept {
  try {
    call(job, first, end);
  } catch (...) {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (!error_) error_ = std::current_exception();
  }
}

/// Takes the next jobs of a run and does them.
/// @return false if none is left
bool ThreadPool::takeJob(size_t run) const {
  std::atomic<uint64_t>& next = tickets_[run].next;
  uint64_t ticket = next.load(std::memory_order_acquire);
  for (;;) {
    const Call call = shared_.call.load(std::memory_order_acquire);
    const void* job = shared_.job.load(std::memory_order_acquire);
    const uint64_t first = ticket & kTakenMask, count = shared_.count.load(std::memory_order_acquire);
    const uint64_t end = endOf(run, shared_.sharing.load(std::memory_order_acquire), count);
    if (first >= end) return false;
    const uint64_t least = shared_.least.load(std::memory_order_acquire);
    const uint64_t most = shared_.most.load(std::memory_order_acquire);
    const uint64_t taken = std::min(end - first, std::min(most, std::max(least, (end - first) / kPartsLeft)));
    // Success means that the round has not changed since these values were read: it cannot end before these jobs are
    // done.
    if (!next.compare_exchange_weak(ticket, ticket + taken, std::memory_order_acq_rel, std::memory_order_acquire))
      continue;
    doJobs(call, job, first, first + taken);
    const bool last = done_.fetch_add(taken, std::memory_order_seq_cst) + taken == count;
    if (last && caller_asleep_.load(std::memory_order_seq_cst)) {
      const std::lock_guard<std::mutex> lock(mutex_);
      ended_.notify_one();
    }
    return true;
  }
}

/// Sleeps until there is a new round that the thread is to share, or the pool stops.
void ThreadPool::sleep(size_t thread, uint64_t round) {
  std::unique_lock<std::mutex> lock(mutex_);
  const auto wanted = [&] { return thread < sharing_.load(std::memory_order_relaxed) || stop_; };
  const auto awake = [&] { return round_.load(std::memory_order_seq_cst) != round || stop_; };
  while (!(wanted() && awake())) {
    wanted_.wait(lock, wanted);
    asleep_.fetch_add(1, std::memory_order_seq_cst);
    if (!awake()) wake_.wait(lock);
    asleep_.fetch_sub(1, std::memory_order_relaxed);
  }
}

void ThreadPool::work(size_t thread) {
  uint64_t round = 0;
  while (!stop_) {
    const auto called = [&] {
      return stop_ ||
             (round_.load(std::memory_order_acquire) != round && thread < sharing_.load(std::memory_order_relaxed));
    };
    if (!watch(kWatch, called)) sleep(thread, round);
    round = round_.load(std::memory_order_acquire);
    if (thread < sharing_.load(std::memory_order_relaxed)) takeJobs(thread);
  }
}

}  // namespace viscera
