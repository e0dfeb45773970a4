// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <functional>

namespace viscera::gpu {

/// Longest that anybody waits for the GPU [s]. What is waited for is a tick or two, or a picture: a second on a slow
/// GPU with as much tissue as its memory holds, ten times less than this; drivers give a kernel that hangs up after 2
/// to 10 s.
constexpr double kLongestWait_s = 10;

enum class FenceState { kPassed, kPending, kFailed };

/// Waits until `poll` says that the fence has passed. No poll counts for more than half of longest_s: in a process that
/// was stopped, or on a machine that slept, the clock goes on while nothing asks. @param poll  waits for so many
/// nanoseconds at most
/// @param what  is waited for, in the message   @throws GpuError  failed, or still pending after longest_s
void awaitFence(const std::function<FenceState(uint64_t nanoseconds)>& poll, const char* what,
                double longest_s = kLongestWait_s);

/// Waits for an OpenGL fence (GLsync). @throws GpuError  as above
void awaitSync(void* sync, const char* what);

/// What the GPU was told before this was made; begins to do it.
class Fence {
 public:
  Fence();
  ~Fence();
  Fence(const Fence&) = delete;
  Fence& operator=(const Fence&) = delete;
  bool hasPassed() const;

 private:
  void* sync_;
};

/// Waits until the GPU has done everything that it was told. @throws GpuError  as above
void awaitGpu(const char* what);

}  // namespace viscera::gpu
