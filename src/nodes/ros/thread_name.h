// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pthread.h>

#include "nodes/ros/crash_stack.h"

namespace viscera::nodes {

/// Names the calling thread for top, gdb and /proc; as all our threads begin with it, gives it its CrashStack.
/// @param name  at most 15 characters
inline void nameThread(const char* name) {
  pthread_setname_np(pthread_self(), name);
  CrashStack::give();
}

}  // namespace viscera::nodes
