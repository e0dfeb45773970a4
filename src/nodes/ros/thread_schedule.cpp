// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "nodes/ros/thread_schedule.h"

#include <pthread.h>
#include <sched.h>
#include <sys/prctl.h>

namespace viscera::nodes {

std::string goFirst(int priority) {
  constexpr unsigned long kSlack_ns = 1;
  prctl(PR_SET_TIMERSLACK, kSlack_ns);
  if (priority == 0) return "ordinary";
  sched_param wanted{};
  wanted.sched_priority = priority;
  const std::string name = "SCHED_FIFO " + std::to_string(priority);
  if (pthread_setschedparam(pthread_self(), SCHED_FIFO, &wanted) == 0) return name;
  return "ordinary; " + name + " is not permitted (RLIMIT_RTPRIO: 'rtprio' in /etc/security/limits.conf)";
}

}  // namespace viscera::nodes
