// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "gpu/limits.h"

#include <cstdlib>
#include <cstring>
#include <optional>
#include <string>

#include "gpu/gl.h"
#include "gpu/software.h"
#include "layout/bindings.h"
#include "viscera/layout/limits.h"
#include "viscera/math/error.h"

namespace viscera::gpu {

namespace {

thread_local std::optional<Limits> known;

size_t asked(GLenum name) {
  GLint64 value = 0;
  glGetInteger64v(name, &value);
  return value < 0 ? 0 : static_cast<size_t>(value);
}

size_t groupsAlongX() {
  GLint value = 0;
  glGetIntegeri_v(GL_MAX_COMPUTE_WORK_GROUP_COUNT, 0, &value);
  return value < 0 ? 0 : static_cast<size_t>(value);
}

/// Returns the choice of $VISCERA_READS, `loads` or `texels`; without it the faster one.
bool readsByLoads() {
  const char* const setting = std::getenv("VISCERA_READS");
  if (!setting) return !isSoftware();
  if (std::strcmp(setting, "loads") == 0) return true;
  if (std::strcmp(setting, "texels") == 0) return false;
  throw GpuError(std::string("VISCERA_READS is '") + setting + "' and must be loads or texels");
}

}  // namespace

Limits neededLimits() {
  Limits out;
  out.storage_bindings = layout::kBindAwakeCells + 1;  // the highest number
  out.storage_blocks = 8;
  out.uniform_bindings = layout::kBindBodyInfluences + 1;
  out.texture_units = layout::kUnitCellMoments + 1;
  out.invocations_per_group = layout::kGroupSize;
  out.groups = 65535;  // Program::dispatch folds more
  out.storage_block_bytes = 1 << 20;
  out.texels = 1 << 16;
  return out;
}

const Limits& driverLimits() {
  if (known) return *known;
  Limits out;
  out.storage_bindings = asked(GL_MAX_SHADER_STORAGE_BUFFER_BINDINGS);
  out.storage_blocks = asked(GL_MAX_COMPUTE_SHADER_STORAGE_BLOCKS);
  out.uniform_bindings = asked(GL_MAX_UNIFORM_BUFFER_BINDINGS);
  out.texture_units = asked(GL_MAX_COMPUTE_TEXTURE_IMAGE_UNITS);
  out.invocations_per_group = asked(GL_MAX_COMPUTE_WORK_GROUP_INVOCATIONS);
  out.groups = groupsAlongX();
  out.storage_block_bytes = asked(GL_MAX_SHADER_STORAGE_BLOCK_SIZE);
  out.texels = asked(GL_MAX_TEXTURE_BUFFER_SIZE);
  out.loads = readsByLoads();
  out.compiles_ahead = !isSoftware();
  known = out;
  return *known;
}

void clearDriverLimits() {
  known.reset();
}

void pretendDriverLimits(const Limits& limits) {
  known = limits;
}

void requireStorageBlocks(const Limits& driver, const std::string& kernel, size_t blocks) {
  if (blocks <= driver.storage_blocks) return;
  throw GpuError("the driver's limits are too small for this scene: GL_MAX_COMPUTE_SHADER_STORAGE_BLOCKS is " +
                 std::to_string(driver.storage_blocks) + " and must be " + std::to_string(blocks) + " for kernel '" +
                 kernel + "'; solver.backend: cpu does not need this kernel");
}

void requireLimits(const Limits& driver, const Limits& needed) {
  std::string small;
  const auto check = [&small](const char* name, size_t has, size_t wanted) {
    if (has >= wanted) return;
    small += (small.empty() ? "" : ", ") + std::string(name) + " is " + std::to_string(has) + " and must be " +
             std::to_string(wanted);
  };
  check("GL_MAX_SHADER_STORAGE_BUFFER_BINDINGS", driver.storage_bindings, needed.storage_bindings);
  check("GL_MAX_COMPUTE_SHADER_STORAGE_BLOCKS", driver.storage_blocks, needed.storage_blocks);
  check("GL_MAX_UNIFORM_BUFFER_BINDINGS", driver.uniform_bindings, needed.uniform_bindings);
  check("GL_MAX_COMPUTE_TEXTURE_IMAGE_UNITS", driver.texture_units, needed.texture_units);
  check("GL_MAX_COMPUTE_WORK_GROUP_INVOCATIONS", driver.invocations_per_group, needed.invocations_per_group);
  check("GL_MAX_COMPUTE_WORK_GROUP_COUNT", driver.groups, needed.groups);
  check("GL_MAX_SHADER_STORAGE_BLOCK_SIZE", driver.storage_block_bytes, needed.storage_block_bytes);
  check("GL_MAX_TEXTURE_BUFFER_SIZE", driver.texels, needed.texels);
  if (!small.empty()) throw GpuError("the driver's limits are too small for the kernels: " + small);
}

}  // namespace viscera::gpu
