// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "gpu/gl.h"
#include "gpu/program.h"
#include "viscera/layout/limits.h"

namespace viscera {

// How the kernels of shaders/surface/ are compiled and run.

inline void bindStorage(uint32_t binding, uint32_t buffer) {
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, binding, buffer);
}

inline gpu::Program surfaceKernel(const std::string& name, std::vector<std::string> features = {}) {
  features.push_back("GROUP_SIZE " + std::to_string(layout::kGroupSize));
  return gpu::Program::compute(name, features);
}

/// Runs one invocation for each of `count`, which is a uniform of the kernel.
inline void runOver(const gpu::Program& kernel, size_t count) {
  kernel.use();
  kernel.set("count", static_cast<uint32_t>(count));
  gpu::Program::dispatch(count, layout::kGroupSize);
}

}  // namespace viscera
