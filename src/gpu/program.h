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

/// Source of an embedded shader with its #include lines expanded (#line kept), after `#version 450 core` and defines.
/// @throws GpuError  no such shader
std::string shaderSource(const std::string& name, const std::vector<std::string>& defines = {});

/// What a compute shader is compiled with: its features, and beside TEXELS LOADS (shaders/solver/tissue/lattice.glsl)
/// where the driver is as fast with that and has storage blocks enough.
std::vector<std::string> withLoads(const std::string& name, const std::vector<std::string>& features);

/// Name of a uniform, which the compiler turns into a number: to set one by its name compares no strings.
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

/// A program. A driver with compiler threads is told to compile it when it is made and asked for the result when it is
/// first used, so that all programs of a session compile side by side. A driver without them (a software rasteriser)
/// compiles it when it is first used: a session runs about a fifth of the programs that its scene might come to need.
class Program {
 public:
  Program();
  /// Compute program from the shader `name`, without its folder. No two blocks or textures may have the same binding.
  /// @param defines  "NAME" or "NAME value", one #define each
  static Program compute(const std::string& name, const std::vector<std::string>& defines = {});
  /// Vertex and fragment program from two shaders.
  static Program graphics(const std::string& vertex, const std::string& fragment,
                          const std::vector<std::string>& defines = {});
  ~Program();
  Program(Program&& other) noexcept;
  Program& operator=(Program&& other) noexcept;

  /// Waits until the driver has compiled it; what a use does first.
  /// @throws GpuError  it does not compile or link: file, line and the driver's log
  void finish() const;
  void use() const;
  /// Enough groups of `group_size` for `invocations`; none is launched for 0. The program must be in use.
  /// @throws GpuError  the first time that this kernel runs: OpenGL has an error pending
  static void dispatch(size_t invocations, uint32_t group_size);
  /// As many groups as the first three words of a buffer say when it is the GPU's turn. @throws GpuError  as dispatch()
  static void dispatchIndirect(const RawBuffer& groups);
  /// Makes storage writes of earlier dispatches visible to later ones.
  static void storageBarrier();
  /// @name Uniforms by name
  /// A value that the program has already costs no OpenGL call, nor does one that the driver found unused. The program
  /// need not be in use; before it is compiled the value is kept until then.
  /// @throws GpuError  the shaders declare no such uniform with any features; or it has another type (said at the first
  /// use of the program at the latest)
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
  /// An array of vectors, or its first ones. @param values  [count][components]
  void setVectors(UniformName name, const float* values, size_t components, size_t count) const;
  /// @}
  explicit operator bool() const { return id_ != 0 || unfinished_ != nullptr; }
  uint32_t id() const {
    finish();
    return id_;
  }

 private:
  /// Of a name that the sources declare.
  struct Uniform {
    uint32_t key;
    int location;  ///< -1: unused
    uint32_t type;
    size_t first, words;  ///< of its value in values_
  };
  explicit Program(std::string name);
  void begin();
  void set(UniformName name, uint32_t type, const void* value, size_t components, size_t count) const;
  const Uniform* changed(UniformName name, uint32_t type, const void* value, size_t words) const;

  mutable uint32_t id_ = 0;  ///< 0 until it is finished
  std::string name_;
  ProgramLabel* label_ = nullptr;
  mutable std::unique_ptr<UnfinishedProgram> unfinished_;  ///< null once it is finished
  mutable std::vector<Uniform> uniforms_;
  mutable std::vector<uint32_t> values_;
};

/// Lists the programs that this thread makes while it lives, so that what makes many can tell the driver of all and
/// still report at the end what the driver cannot compile. They must be of one context.
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

/// Name of the kernel that this thread used last, for messages.
std::string lastKernel();

/// For tests: the first dispatch() of each program that is made from now on asks OpenGL whether something is bound to
/// all blocks and textures of the program in use, and throws GpuError with the names of those where nothing is.
void checkDispatches(bool check);

}  // namespace viscera::gpu
