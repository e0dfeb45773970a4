// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include <GL/glew.h>

#include <algorithm>
#include <chrono>
#include <string>

#include "bench/harness/machine/machine.h"
#include "gpu/buffer.h"
#include "gpu/limits.h"
#include "gpu/program.h"
#include "viscera/layout/limits.h"

namespace viscera::bench {

namespace {

constexpr int kRepeats = 5;
constexpr size_t kInvocations = size_t{1} << 16;
constexpr double kOperations = 16;  // operations per round of an invocation (bench_fma.comp)

template <class Work>
double secondsOnGpu(const Work& work) {
  glFinish();
  const auto start = std::chrono::steady_clock::now();
  work();
  glFinish();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

template <class Work>
double bestOnGpu(const Work& work) {
  warmUpGpu(work);
  double best_s = 1e9;
  for (int i = 0; i < kRepeats; ++i) best_s = std::min(best_s, secondsOnGpu(work));
  return best_s;
}

}  // namespace

void warmUpGpu(const std::function<void()>& work) {
  constexpr double kWarmUp_s = 0.4;
  const auto begun = std::chrono::steady_clock::now();
  do secondsOnGpu(work);
  while (std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count() < kWarmUp_s);
}

double gpuCopyRate(size_t mebibytes) {
  const size_t bytes_each = std::min(mebibytes << 20, gpu::driverLimits().storage_block_bytes);
  gpu::Buffer<layout::vec4> from(bytes_each / sizeof(layout::vec4)), to(from.size());
  const double bytes = static_cast<double>(from.size() * sizeof(layout::vec4));
  const gpu::Program program =
      gpu::Program::compute("bench_copy.comp", {"GROUP_SIZE " + std::to_string(layout::kGroupSize)});
  program.use();
  from.bindStorage(0);
  to.bindStorage(1);
  return 2 * bytes / bestOnGpu([&] { gpu::Program::dispatch(from.size(), layout::kGroupSize); });
}

double gpuFmaRate(double seconds) {
  const gpu::Program program =
      gpu::Program::compute("bench_fma.comp", {"GROUP_SIZE " + std::to_string(layout::kGroupSize)});
  gpu::Buffer<layout::vec4> out(kInvocations);
  program.use();
  out.bindStorage(0);
  const auto run = [&program](int rounds) {
    program.set("rounds", rounds);
    gpu::Program::dispatch(kInvocations, layout::kGroupSize);
  };
  int rounds = 64;
  run(rounds);  // compiles the shader
  const double once_s = secondsOnGpu([&] { run(rounds); });
  rounds = std::clamp(static_cast<int>(rounds * seconds / kRepeats / once_s), rounds, 1 << 20);
  return kOperations * kInvocations * rounds / bestOnGpu([&] { run(rounds); });
}

}  // namespace viscera::bench
