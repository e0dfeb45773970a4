// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "gpu/gl.h"
#include "gpu/program.h"
#include "gpu/shader_text.h"

namespace viscera::gpu {

/// One shader of a program.
struct ShaderStage {
  GLenum kind;
  uint32_t id;  ///< 0: compilation was not started
  std::string name;
  ShaderFiles files;
  std::string source;  ///< until then
};

/// A uniform's value that was set before its program was compiled.
struct PendingValue {
  UniformName name;
  uint32_t type;
  size_t components, count;  ///< words of an element, elements
  std::vector<uint32_t> words;
};

/// State of a Program until its first use: its shaders, and the values set so far. Listed by MadePrograms.
struct UnfinishedProgram {
  uint32_t id = 0;  ///< 0: compilation was not started
  std::string name;
  std::vector<ShaderStage> stages;
  std::vector<std::string> uniforms;  ///< that its shaders declare, with repetitions
  std::vector<PendingValue> values;

  UnfinishedProgram();
  UnfinishedProgram(const UnfinishedProgram&) = delete;
  UnfinishedProgram& operator=(const UnfinishedProgram&) = delete;
  ~UnfinishedProgram();
  void add(GLenum kind, const std::string& shader, const std::vector<std::string>& defines);
  /// Starts compilation and linking, once.
  void start();
  /// Checks the result. @throws GpuError  it does not compile or link
  void require() const;
  /// Stores a value until the program is compiled. @param value  [count][components] words
  /// @throws GpuError  the shaders declare no such uniform; it was set with another type before
  void keep(UniformName uniform, uint32_t type, const void* value, size_t components, size_t count);
};

}  // namespace viscera::gpu
