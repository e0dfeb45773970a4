// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <vector>

namespace viscera::gpu {

/// Untyped GPU memory; other code uses Buffer<T>.
class RawBuffer {
 public:
  RawBuffer() = default;
  /// Allocates at least 16 bytes. @param name  for messages, of static lifetime   @param data  [bytes]; null: zeros
  /// @throws GpuError  out of memory, with name and size
  explicit RawBuffer(size_t bytes, const char* name = "without a name", const void* data = nullptr);
  ~RawBuffer();
  RawBuffer(RawBuffer&& other) noexcept;
  RawBuffer& operator=(RawBuffer&& other) noexcept;

  void write(size_t offset, size_t bytes, const void* data);
  /// Reads bytes. Waits for the GPU. @throws GpuError  it does not answer (awaitGpu)
  void read(size_t offset, size_t bytes, void* data) const;
  void clear();                           ///< to zero, on the GPU
  void copyFrom(const RawBuffer& other);  ///< all of it, on the GPU, to the beginning of this one, which is no shorter
  void bindStorage(uint32_t binding) const;  ///< @throws GpuError  as requireBlock()
  /// Checks the size. @throws GpuError  larger than the driver's largest storage block
  void requireBlock() const;
  void bindUniform(uint32_t binding, size_t offset, size_t bytes) const;
  uint32_t id() const { return id_; }
  size_t bytes() const { return bytes_; }
  const char* name() const { return name_; }

 private:
  void awaitClear();
  uint32_t id_ = 0;
  size_t bytes_ = 0;
  const char* name_ = "";
  bool cleared_ = false;  ///< on the GPU, and not waited for since
};

/// A buffer as texels, for gathers: several times faster than storage loads where a software rasteriser runs the
/// kernels, somewhat slower on a GPU (docs/gpu.md).
enum class TexelFormat { kRgba32f, kRgba32ui, kRg32f, kR32f, kR32ui };
class TexelView {
 public:
  TexelView() = default;
  TexelView(const RawBuffer& buffer, TexelFormat format);  ///< @throws GpuError if the driver takes no buffer this long
  ~TexelView();
  TexelView(TexelView&& other) noexcept;
  TexelView& operator=(TexelView&& other) noexcept;
  void bind(uint32_t unit) const;
  uint32_t id() const { return id_; }

 private:
  uint32_t id_ = 0;
};

/// Returns the size of all buffers of this process [bytes], without those of read-back rings.
size_t bufferBytes();

/// Binds several storage buffers at bindings first, first + 1, ... in one call. @param buffers  ids
void bindStorages(uint32_t first, std::initializer_list<uint32_t> buffers);
/// Binds several texel views at units first, first + 1, ... in one call. @param views  ids
void bindTexels(uint32_t first, std::initializer_list<uint32_t> views);

/// Move-only array of T on the GPU. T must have the std430 layout of its counterpart in GLSL (layout/).
template <class T>
class Buffer {
 public:
  Buffer() = default;
  /// @param name  for messages, of static lifetime: a literal
  explicit Buffer(size_t count, const char* name = "without a name") : raw_(count * sizeof(T), name), count_(count) {}
  explicit Buffer(const std::vector<T>& values, const char* name = "without a name")
      : raw_(values.size() * sizeof(T), name, values.data()), count_(values.size()) {}

  void write(const std::vector<T>& values, size_t first = 0) { write(values.data(), values.size(), first); }
  void write(const T* values, size_t count, size_t first = 0) {
    if (count) raw_.write(first * sizeof(T), count * sizeof(T), values);
  }
  std::vector<T> read() const {
    std::vector<T> out(count_);
    if (count_) raw_.read(0, count_ * sizeof(T), out.data());
    return out;
  }
  void clear() { raw_.clear(); }
  void copyFrom(const Buffer& other) { raw_.copyFrom(other.raw_); }  ///< to the beginning of this one
  void bindStorage(uint32_t binding) const { raw_.bindStorage(binding); }
  void bindUniform(uint32_t binding) const { bindUniform(binding, 0, count_); }
  /// Binds a range as a uniform block. @param first  its bytes must be a multiple of GL_UNIFORM_BUFFER_OFFSET_ALIGNMENT
  /// (256 is always enough)
  void bindUniform(uint32_t binding, size_t first, size_t count) const {
    raw_.bindUniform(binding, first * sizeof(T), count * sizeof(T));
  }
  uint32_t id() const { return raw_.id(); }
  const RawBuffer& raw() const { return raw_; }
  size_t size() const { return count_; }

 private:
  RawBuffer raw_;
  size_t count_ = 0;
};

}  // namespace viscera::gpu
