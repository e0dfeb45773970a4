// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>

namespace viscera {

/// Threads that step tissue on the processor.
class ThreadPool;

/// Threads that several sessions share (SessionOptions): they take turns, a round of jobs at a time, also where the
/// sessions step on threads of their own. How many there are changes no result.
/// @param threads  with the one that steps; 0: as many as the machine has
std::shared_ptr<ThreadPool> makeThreadPool(int threads = 0);

}  // namespace viscera
