// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pthread.h>

#include <chrono>
#include <ctime>
#include <mutex>
#include <system_error>

#include "viscera/math/types.h"

namespace viscera::nodes {

/// A mutex with priority inheritance: the holder runs with the priority of the thread that waits for it. An ordinary
/// thread that is preempted while it holds the mutex does not delay a real-time thread for longer than its critical
/// section.
class PriorityMutex {
 public:
  PriorityMutex() {
    pthread_mutexattr_t how;
    pthread_mutexattr_init(&how);
    pthread_mutexattr_setprotocol(&how, PTHREAD_PRIO_INHERIT);
    int refused = pthread_mutex_init(&mutex_, &how);
    if (refused) refused = pthread_mutex_init(&mutex_, nullptr);  // the kernel lacks priority inheritance
    pthread_mutexattr_destroy(&how);
    require(refused);
  }
  ~PriorityMutex() { pthread_mutex_destroy(&mutex_); }
  PriorityMutex(const PriorityMutex&) = delete;
  PriorityMutex& operator=(const PriorityMutex&) = delete;

  void lock() { require(pthread_mutex_lock(&mutex_)); }
  bool try_lock() { return pthread_mutex_trylock(&mutex_) == 0; }
  void unlock() { pthread_mutex_unlock(&mutex_); }

 private:
  friend class PriorityCondition;
  static void require(int error) {
    if (error) throw std::system_error(error, std::generic_category(), "mutex");
  }
  pthread_mutex_t mutex_;
};

/// A condition variable for PriorityMutex, on the steady clock.
class PriorityCondition {
 public:
  PriorityCondition() {
    pthread_condattr_t how;
    pthread_condattr_init(&how);
    pthread_condattr_setclock(&how, CLOCK_MONOTONIC);
    pthread_cond_init(&condition_, &how);
    pthread_condattr_destroy(&how);
  }
  ~PriorityCondition() { pthread_cond_destroy(&condition_); }
  PriorityCondition(const PriorityCondition&) = delete;
  PriorityCondition& operator=(const PriorityCondition&) = delete;

  void notify_one() { pthread_cond_signal(&condition_); }
  void notify_all() { pthread_cond_broadcast(&condition_); }

  /// Waits until the predicate holds. @returns whether it holds; false only after `due` has passed
  template <class Fulfilled>
  bool wait_until(std::unique_lock<PriorityMutex>& lock, SteadyTime due, Fulfilled fulfilled) {
    const auto since = due.time_since_epoch();
    const auto whole = std::chrono::floor<std::chrono::seconds>(since);
    const timespec at{static_cast<time_t>(whole.count()),
                      static_cast<long>(std::chrono::nanoseconds(since - whole).count())};
    while (!fulfilled()) {
      if (pthread_cond_timedwait(&condition_, &lock.mutex()->mutex_, &at) != 0) return fulfilled();
    }
    return true;
  }
  template <class Fulfilled>
  bool wait_for(std::unique_lock<PriorityMutex>& lock, std::chrono::nanoseconds span, Fulfilled fulfilled) {
    return wait_until(lock, SteadyTime::clock::now() + span, fulfilled);
  }

 private:
  pthread_cond_t condition_;
};

}  // namespace viscera::nodes
