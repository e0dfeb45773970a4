// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <functional>

namespace viscera::gpu {

/// Longest wait for the GPU [s]. Waits are for a tick or two, or an image. On a slow GPU, with as much tissue as its
/// memory holds, that takes a second, a tenth of this. Drivers stop a kernel that hangs after 2 to 10 s.
constexpr double kLongestWait_s = 10;

enum class FenceState { kPassed, kPending, kFailed };

/// Waits until `poll` says that the fence has passed. One poll counts for at most half of longest_s, as the clock goes
/// on while a process is stopped or a machine sleeps. @param poll  waits for so many nanoseconds at most
/// @param what  is waited for, in the message   @throws GpuError  failed, or still pending after longest_s
void awaitFence(const std::function<FenceState(uint64_t nanoseconds)>& poll, const char* what,
                double longest_s = kLongestWait_s);

/// Waits for an OpenGL fence (GLsync). @throws GpuError  as above
void awaitSync(void* sync, const char* what);

/// Fence after all commands given so far; flushes them to the GPU.
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

/// Waits until the GPU has executed all commands. @throws GpuError  as above
void awaitGpu(const char* what);

}  // namespace viscera::gpu
