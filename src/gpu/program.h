// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace viscera::gpu {

class RawBuffer;

/// Returns the source of an embedded shader with its #include lines expanded (#line kept), after `#version 450 core`
/// and defines.
/// @throws GpuError  no such shader
std::string shaderSource(const std::string& name, const std::vector<std::string>& defines = {});

/// Returns the defines of a compute shader: its features, and LOADS in addition to TEXELS
/// (shaders/solver/tissue/lattice.glsl) where the driver is as fast with that and has enough storage blocks.
std::vector<std::string> withLoads(const std::string& name, const std::vector<std::string>& features);

/// Name of a uniform as a number, computed at compile time: setting one by name compares no strings.
class UniformName {
 public:
  template <size_t N>
  constexpr UniformName(const char (&name)[N])  // implicit: set("dt_s", dt_s)
      : text_(name), key_(keyOf(name, std::make_index_sequence<N - 1>())) {}
  constexpr uint32_t key() const { return key_; }
  constexpr const char* text() const { return text_; }

  static constexpr uint32_t kKeyStart = 2166136261u;  // FNV-1a
  static constexpr uint32_t keyStep(uint32_t key, char c) { return (key ^ static_cast<unsigned char>(c)) * 16777619u; }

 private:
  template <size_t... I>
  static constexpr uint32_t keyOf(const char* name, std::index_sequence<I...>) {
    uint32_t key = kKeyStart;
    ((key = keyStep(key, name[I])), ...);
    return key;
  }

  const char* text_;
  uint32_t key_;
};

struct ProgramLabel;
struct UnfinishedProgram;

/// A program. A driver with compiler threads starts to compile it when it is made, and its result is queried on first
/// use, so that all programs of a session compile in parallel. A driver without them (a software rasteriser) compiles
/// it on first use: a session runs about a fifth of the programs that its scene might need.
class Program {
 public:
  Program();
  /// Returns a compute program from the shader `name`, without its folder. No two blocks or textures may have the same
  /// binding.
  /// @param defines  "NAME" or "NAME value", one #define each
  static Program compute(const std::string& name, const std::vector<std::string>& defines = {});
  /// Returns a vertex and fragment program from two shaders.
  static Program graphics(const std::string& vertex, const std::string& fragment,
                          const std::vector<std::string>& defines = {});
  ~Program();
  Program(Program&& other) noexcept;
  Program& operator=(Program&& other) noexcept;

  /// Waits until the driver has compiled it. Any use does this first.
  /// @throws GpuError  it does not compile or link: file, line and the driver's log
  void finish() const;
  void use() const;
  /// Launches enough groups of `group_size` for `invocations`; none for 0. The program must be in use.
  /// @throws GpuError  the first time that this kernel runs: OpenGL has an error pending
  static void dispatch(size_t invocations, uint32_t group_size);
  /// Launches as many groups as the first three words of a buffer say at execution on the GPU. @throws GpuError  as
  /// dispatch()
  static void dispatchIndirect(const RawBuffer& groups);
  /// Makes storage writes of earlier dispatches visible to later ones.
  static void storageBarrier();
  /// @name Uniforms by name
  /// A value that the program already has makes no OpenGL call, nor does a uniform that the driver found unused. The
  /// program need not be in use; before it is compiled the value is stored.
  /// @throws GpuError  the shaders declare no such uniform with any features; or it has another type (thrown at the
  /// first use of the program at the latest)
  /// @{
  void set(UniformName name, uint32_t value) const;
  void set(UniformName name, int32_t value) const;
  void set(UniformName name, float value) const;
  void set(UniformName name, uint32_t x, uint32_t y) const;  ///< uvec2
  template <size_t N>
  void set(UniformName name, const float (&value)[N]) const {  ///< vec2, vec3, vec4
    static_assert(N >= 2 && N <= 4);
    setVectors(name, value, N, 1);
  }
  void setMatrix(UniformName name, const float* values) const;  ///< mat4: [16] column by column
  /// Sets an array of vectors, or its first ones. @param values  [count][components]
  void setVectors(UniformName name, const float* values, size_t components, size_t count) const;
  /// @}
  explicit operator bool() const { return id_ != 0 || unfinished_ != nullptr; }
  uint32_t id() const {
    finish();
    return id_;
  }

 private:
  /// A uniform that the sources declare.
  struct Uniform {
    uint32_t key;
    int location;  ///< -1: unused
    uint32_t type;
    size_t first, words;  ///< place of its value in values_, size
  };
  explicit Program(std::string name);
  void begin();
  void set(UniformName name, uint32_t type, const void* value, size_t components, size_t count) const;
  const Uniform* changed(UniformName name, uint32_t type, const void* value, size_t words) const;

  mutable uint32_t id_ = 0;  ///< 0 until finished
  std::string name_;
  ProgramLabel* label_ = nullptr;
  mutable std::unique_ptr<UnfinishedProgram> unfinished_;  ///< null once finished
  mutable std::vector<Uniform> uniforms_;
  mutable std::vector<uint32_t> values_;
};

/// Lists the programs that this thread makes while it lives. So a caller that makes many can start all of them and
/// report compile errors at the end. They must be of one context.
class MadePrograms {
 public:
  MadePrograms();
  ~MadePrograms();
  MadePrograms(const MadePrograms&) = delete;
  MadePrograms& operator=(const MadePrograms&) = delete;
  /// Waits for those that the driver is compiling. @throws GpuError  as Program::finish()
  void require() const;

 private:
  std::set<UnfinishedProgram*> made_;
  std::set<UnfinishedProgram*>* before_;
};

/// Returns the name of the kernel that this thread used last, for messages.
std::string lastKernel();

/// Sets whether the first dispatch() of each new program checks that all blocks and textures of the program are bound,
/// and throws GpuError with the names of those that are not. For tests.
void checkDispatches(bool check);

}  // namespace viscera::gpu
