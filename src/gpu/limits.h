// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace viscera::gpu {

/// Limits of a driver for which OpenGL 4.5 guarantees less than the kernels use.
struct Limits {
  size_t storage_bindings = 0;       ///< GL_MAX_SHADER_STORAGE_BUFFER_BINDINGS
  size_t storage_blocks = 0;         ///< GL_MAX_COMPUTE_SHADER_STORAGE_BLOCKS: of one kernel
  size_t uniform_bindings = 0;       ///< GL_MAX_UNIFORM_BUFFER_BINDINGS
  size_t texture_units = 0;          ///< GL_MAX_COMPUTE_TEXTURE_IMAGE_UNITS
  size_t invocations_per_group = 0;  ///< GL_MAX_COMPUTE_WORK_GROUP_INVOCATIONS
  size_t groups = 0;                 ///< GL_MAX_COMPUTE_WORK_GROUP_COUNT, along x
  size_t storage_block_bytes = 0;    ///< GL_MAX_SHADER_STORAGE_BLOCK_SIZE
  size_t texels = 0;                 ///< GL_MAX_TEXTURE_BUFFER_SIZE
  bool loads = false;                ///< storage loads are as fast as texel fetches: on all but software rasterisers
  bool compiles_ahead = true;        ///< compiles programs on threads of its own: all but software rasterisers
};

/// Returns the limits that every scene needs; sizes are those of a scene of some thousand nodes. Kernels with more
/// blocks are checked before they are linked (requireStorageBlocks), larger buffers when they are made or first bound
/// (buffer.h).
Limits neededLimits();

/// Returns the limits of the current context's driver; queried once for each thread that has one.
const Limits& driverLimits();
/// Discards the queried limits: another context may have another driver.
void clearDriverLimits();
/// Sets the limits on this thread until clearDriverLimits(), for tests.
void pretendDriverLimits(const Limits& limits);

/// Checks limits. @throws GpuError  names every limit that is too small, with its value and the needed one
void requireLimits(const Limits& driver, const Limits& needed);
/// Checks the storage blocks of one kernel, where a scene needs more than OpenGL guarantees.
/// @throws GpuError  names the kernel, the limit, its value, the needed one, and what can be done
void requireStorageBlocks(const Limits& driver, const std::string& kernel, size_t blocks);

}  // namespace viscera::gpu
