// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace viscera::gpu {

/// Limits of a driver that OpenGL 4.5 promises less of than the kernels use.
struct Limits {
  size_t storage_bindings = 0;       ///< GL_MAX_SHADER_STORAGE_BUFFER_BINDINGS
  size_t storage_blocks = 0;         ///< GL_MAX_COMPUTE_SHADER_STORAGE_BLOCKS: of one kernel
  size_t uniform_bindings = 0;       ///< GL_MAX_UNIFORM_BUFFER_BINDINGS
  size_t texture_units = 0;          ///< GL_MAX_COMPUTE_TEXTURE_IMAGE_UNITS
  size_t invocations_per_group = 0;  ///< GL_MAX_COMPUTE_WORK_GROUP_INVOCATIONS
  size_t groups = 0;                 ///< GL_MAX_COMPUTE_WORK_GROUP_COUNT, along x
  size_t storage_block_bytes = 0;    ///< GL_MAX_SHADER_STORAGE_BLOCK_SIZE
  size_t texels = 0;                 ///< GL_MAX_TEXTURE_BUFFER_SIZE
  bool loads = false;          ///< storage loads are no slower than texel fetches: all but rasterisers on the processor
  bool compiles_ahead = true;  ///< compiles programs on threads of its own: all but rasterisers on the processor
};

/// What every scene needs; of sizes, what a scene of some thousand nodes does. Kernels with more blocks say so before
/// they are linked (requireStorageBlocks), larger buffers when they are made or first bound (buffer.h).
Limits neededLimits();

/// Of the current context's driver; asked once for each thread that has one.
const Limits& driverLimits();
/// Asks again: another context may be another driver's.
void forgetDriverLimits();
/// For tests: as if the driver had said so, on this thread and until that.
void pretendDriverLimits(const Limits& limits);

/// @throws GpuError  names every limit that is too small, with what it is and what is needed
void requireLimits(const Limits& driver, const Limits& needed);
/// Of one kernel, where a scene needs one that has more blocks than OpenGL promises.
/// @throws GpuError  names the kernel, the limit, what it is and what is needed, and what can be done
void requireStorageBlocks(const Limits& driver, const std::string& kernel, size_t blocks);

}  // namespace viscera::gpu
