// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pthread.h>

#include "nodes/ros/crash_stack.h"

namespace viscera::nodes {

/// Sets the name of the calling thread for top, gdb and /proc. Also creates its CrashStack, since every thread of ours
/// calls this first.
/// @param name  at most 15 characters
inline void nameThread(const char* name) {
  pthread_setname_np(pthread_self(), name);
  CrashStack::give();
}

}  // namespace viscera::nodes
