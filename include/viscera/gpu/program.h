// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace viscera::gpu {

/// Source of an embedded shader with its #include lines expanded (#line kept), after `#version 450 core` and defines.
/// @throws GpuError  no such shader
std::string shaderSource(const std::string& name, const std::vector<std::string>& defines = {});

/// A linked program. Compile and link errors throw GpuError with file, line and the driver's log.
class Program {
 public:
  Program() = default;
  /// Compute program from the shader `name`, without its folder. @param defines  "NAME" or "NAME value", one #define
  /// each
  static Program compute(const std::string& name, const std::vector<std::string>& defines = {});
  /// Vertex and fragment program from two shaders.
  static Program graphics(const std::string& vertex, const std::string& fragment,
                          const std::vector<std::string>& defines = {});
  ~Program();
  Program(Program&& other) noexcept;
  Program& operator=(Program&& other) noexcept;

  void use() const;
  /// Enough groups of `group_size` for `invocations`; none is launched for 0. The program must be in use.
  static void dispatch(size_t invocations, uint32_t group_size);
  /// Makes storage writes of earlier dispatches visible to later ones.
  static void storageBarrier();
  int location(const char* uniform) const;  ///< -1 where the compiler removed it
  /// @name Uniforms by location; a value that the program has already costs no OpenGL call
  /// Only for programs whose uniforms nobody sets in another way. The program need not be in use.
  /// @{
  void set(int location, uint32_t value) const;
  void set(int location, float value) const;
  template <size_t N>
  void set(int location, const float (&value)[N]) const {  ///< vec3, vec4
    static_assert(N == 3 || N == 4);
    setVector(location, value, N);
  }
  /// @}
  explicit operator bool() const { return id_ != 0; }
  uint32_t id() const { return id_; }

 private:
  void setVector(int location, const float* value, size_t components) const;
  using Words = std::array<uint32_t, 4>;
  bool changes(int location, const void* value, size_t bytes) const;

  uint32_t id_ = 0;
  mutable std::vector<Words> uniforms_;  ///< their values, by location, as far as they were set
};

}  // namespace viscera::gpu
