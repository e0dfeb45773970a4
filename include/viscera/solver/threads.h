// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>

#include "viscera/api.h"

namespace viscera {  // internal
/// CPU threads that step tissue.
class ThreadPool;
}  // namespace viscera

namespace VISCERA_PUBLIC viscera {

/// Creates threads that several sessions can share (SessionOptions). Sessions take turns, one round of jobs at a time,
/// even if they step on threads of their own. The number of threads changes no result.
/// @param threads  number including the calling thread; 0: as many as the machine has
std::shared_ptr<ThreadPool> makeThreadPool(int threads = 0);

}  // namespace viscera
