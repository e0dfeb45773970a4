// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace viscera::gpu {

/// A uniform of a linked program, outside of blocks, that the driver has kept; not a texture.
struct ActiveUniform {
  std::string name;
  int location;
  uint32_t type;  ///< GL_FLOAT, ...
  int count;      ///< elements of an array, else 1
};
std::vector<ActiveUniform> activeUniforms(uint32_t program);

/// Returns the names of all uniforms that a source declares outside of blocks, with any features.
std::vector<std::string> declaredUniforms(const std::string& source);

/// Kinds of bindings, each with its own numbers: storage blocks, uniform blocks and texture units.
enum class BindingKind { kStorage, kUniform, kTexture };
/// A binding that a program needs before it runs.
struct Binding {
  BindingKind kind;
  uint32_t number;
  std::string name;  ///< of the block or the sampler
};
std::vector<Binding> bindingsOf(uint32_t program);

/// Checks that numbers are unique. @throws GpuError  two bindings of one kind have the same number
void refuseSharedNumbers(const std::vector<Binding>& bindings, const std::string& program);

/// Returns the names of bindings to which nothing is bound now.
std::vector<std::string> unboundNow(const std::vector<Binding>& bindings);

}  // namespace viscera::gpu
