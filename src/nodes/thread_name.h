// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pthread.h>

namespace viscera::nodes {

/// Names the calling thread for top, gdb and /proc. @param name  at most 15 characters
inline void nameThread(const char* name) {
  pthread_setname_np(pthread_self(), name);
}

}  // namespace viscera::nodes
