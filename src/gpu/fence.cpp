// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "gpu/fence.h"

#include <algorithm>
#include <chrono>

#include "gpu/gl.h"
#include "math/number_text.h"
#include "viscera/math/error.h"

namespace viscera::gpu {

void awaitFence(const std::function<FenceState(uint64_t nanoseconds)>& poll, const char* what, double longest_s) {
  using Clock = std::chrono::steady_clock;
  constexpr uint64_t kOnce_ns = 1000000000;
  double waited_s = 0;
  for (auto begun = Clock::now();;) {
    const FenceState state = poll(kOnce_ns);
    if (state == FenceState::kPassed) return;
    if (state == FenceState::kFailed) {
      throw GpuError(std::string("waiting for the GPU failed (") + what + "): " + glErrorText(glGetError()));
    }
    const auto now = Clock::now();
    waited_s += std::min(std::chrono::duration<double>(now - begun).count(), longest_s / 2);
    begun = now;
    if (waited_s < longest_s) continue;
    TextOut out;
    out << "the GPU has not answered for " << longest_s << " s (" << what << "): it hangs or was lost";
    throw GpuError(out.str());
  }
}

void awaitSync(void* sync, const char* what) {
  const auto poll = [sync](uint64_t nanoseconds) {
    const GLenum result = glClientWaitSync(static_cast<GLsync>(sync), GL_SYNC_FLUSH_COMMANDS_BIT, nanoseconds);
    if (result == GL_WAIT_FAILED) return FenceState::kFailed;
    return result == GL_TIMEOUT_EXPIRED ? FenceState::kPending : FenceState::kPassed;
  };
  awaitFence(poll, what);
}

Fence::Fence() : sync_(glFenceSync(GL_SYNC_GPU_COMMANDS_COMPLETE, 0)) {
  glFlush();
}

Fence::~Fence() {
  glDeleteSync(static_cast<GLsync>(sync_));
}

/// Returns whether the fence has passed. The next read reports a failure.
bool Fence::hasPassed() const {
  return glClientWaitSync(static_cast<GLsync>(sync_), 0, 0) != GL_TIMEOUT_EXPIRED;
}

void awaitGpu(const char* what) {
  struct Fence {
    GLsync sync = glFenceSync(GL_SYNC_GPU_COMMANDS_COMPLETE, 0);
    ~Fence() { glDeleteSync(sync); }
  } fence;
  if (!fence.sync) throw GpuError(std::string("glFenceSync failed (") + what + "): " + glErrorText(glGetError()));
  awaitSync(fence.sync, what);
}

}  // namespace viscera::gpu
