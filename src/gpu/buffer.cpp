// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "gpu/buffer.h"

#include <cassert>

#include <algorithm>
#include <array>
#include <atomic>
#include <cstring>
#include <utility>
#include <vector>

#include "gpu/fence.h"
#include "gpu/gl.h"
#include "gpu/limits.h"
#include "viscera/gpu/context.h"
#include "viscera/math/error.h"

namespace viscera::gpu {

namespace {

std::atomic<size_t> live_bytes{0};

std::string described(const char* name, size_t bytes) {
  return std::string("buffer '") + name + "' of " + std::to_string(bytes) + " bytes";
}

}  // namespace

size_t bufferBytes() {
  return live_bytes;
}

RawBuffer::RawBuffer(size_t bytes, const char* name, const void* data) : bytes_(bytes), name_(name) {
  constexpr size_t kSmallest = 16;               // drivers refuse storage of size 0
  constexpr size_t kFewZeros = size_t{1} << 16;  // sent from the host, so that the next write need not wait for a clear
  const std::vector<char> zeros(!data && bytes <= kFewZeros ? std::max(bytes, kSmallest) : 0);
  if (!zeros.empty()) data = zeros.data();
  std::array<char, kSmallest> padded{};
  if (data && bytes < kSmallest) data = std::memcpy(padded.data(), data, bytes);
  checkErrors("work before the creation of a buffer");
  glCreateBuffers(1, &id_);
  countObject();
  glNamedBufferStorage(id_, static_cast<GLsizeiptr>(std::max(bytes, kSmallest)), data, GL_DYNAMIC_STORAGE_BIT);
  GLenum code = glGetError();
  if (code == GL_NO_ERROR && !data) {
    clear();  // some drivers allocate memory when it is first used
    code = glGetError();
  }
  if (code == GL_NO_ERROR) {
    live_bytes += bytes_;
    return;
  }
  glDeleteBuffers(1, &id_);
  throw GpuError("no memory for " + described(name, bytes) + ": " + glErrorText(code) + "; use a larger spacing_m");
}

RawBuffer::~RawBuffer() {
  if (!id_) return;
  glDeleteBuffers(1, &id_);
  live_bytes -= bytes_;
}

RawBuffer::RawBuffer(RawBuffer&& other) noexcept
    : id_(std::exchange(other.id_, 0)),
      bytes_(std::exchange(other.bytes_, 0)),
      name_(other.name_),
      cleared_(std::exchange(other.cleared_, false)) {}

RawBuffer& RawBuffer::operator=(RawBuffer&& other) noexcept {
  std::swap(id_, other.id_);
  std::swap(bytes_, other.bytes_);
  std::swap(name_, other.name_);
  std::swap(cleared_, other.cleared_);
  return *this;
}

/// Waits for a clear. NVIDIA's driver 580 executes a clear after a later write of 64 KiB or more (docs/gpu.md).
void RawBuffer::awaitClear() {
  if (cleared_) awaitGpu(described(name_, bytes_).c_str());
  cleared_ = false;
}

void RawBuffer::write(size_t offset, size_t bytes, const void* data) {
  awaitClear();
  glNamedBufferSubData(id_, static_cast<GLintptr>(offset), static_cast<GLsizeiptr>(bytes), data);
}

void RawBuffer::read(size_t offset, size_t bytes, void* data) const {
  glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
  awaitGpu(described(name_, bytes_).c_str());
  glGetNamedBufferSubData(id_, static_cast<GLintptr>(offset), static_cast<GLsizeiptr>(bytes), data);
}

void RawBuffer::clear() {
  const uint32_t zero = 0;
  glClearNamedBufferData(id_, GL_R32UI, GL_RED_INTEGER, GL_UNSIGNED_INT, &zero);
  cleared_ = true;
}

void RawBuffer::copyFrom(const RawBuffer& other) {
  assert(other.bytes_ <= bytes_);
  awaitClear();
  glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
  glCopyNamedBufferSubData(other.id_, id_, 0, 0, static_cast<GLsizeiptr>(other.bytes_));
}

namespace {

GLenum glName(TexelFormat format) {
  switch (format) {
    case TexelFormat::kRgba32f:
      return GL_RGBA32F;
    case TexelFormat::kRgba32ui:
      return GL_RGBA32UI;
    case TexelFormat::kRg32f:
      return GL_RG32F;
    case TexelFormat::kR32f:
      return GL_R32F;
    case TexelFormat::kR32ui:
      break;
  }
  return GL_R32UI;
}

}  // namespace

TexelView::TexelView(const RawBuffer& buffer, TexelFormat format) {
  const bool wide = format == TexelFormat::kRgba32f || format == TexelFormat::kRgba32ui;
  const size_t texels = buffer.bytes() / (wide ? 16 : format == TexelFormat::kRg32f ? 8 : 4);
  const GLenum name = glName(format);
  GLint most = 0;
  glGetIntegerv(GL_MAX_TEXTURE_BUFFER_SIZE, &most);
  if (texels > static_cast<size_t>(most)) {
    throw GpuError(described(buffer.name(), buffer.bytes()) + ", " + std::to_string(texels) +
                   " texels, is longer than the driver's GL_MAX_TEXTURE_BUFFER_SIZE, " + std::to_string(most) +
                   "; use a larger spacing_m");
  }
  glCreateTextures(GL_TEXTURE_BUFFER, 1, &id_);
  countObject();
  glTextureBuffer(id_, name, buffer.id());
}

TexelView::~TexelView() {
  if (id_) glDeleteTextures(1, &id_);
}

TexelView::TexelView(TexelView&& other) noexcept : id_(std::exchange(other.id_, 0)) {}

TexelView& TexelView::operator=(TexelView&& other) noexcept {
  std::swap(id_, other.id_);
  return *this;
}

void TexelView::bind(uint32_t unit) const {
  glBindTextureUnit(unit, id_);
}

void bindStorages(uint32_t first, std::initializer_list<uint32_t> buffers) {
  glBindBuffersBase(GL_SHADER_STORAGE_BUFFER, first, static_cast<GLsizei>(buffers.size()), buffers.begin());
}

void bindTexels(uint32_t first, std::initializer_list<uint32_t> views) {
  glBindTextures(first, static_cast<GLsizei>(views.size()), views.begin());
}

void RawBuffer::requireBlock() const {
  const size_t most = driverLimits().storage_block_bytes;
  if (bytes_ <= most) return;
  throw GpuError(described(name_, bytes_) + " is longer than the driver's GL_MAX_SHADER_STORAGE_BLOCK_SIZE, " +
                 std::to_string(most) + "; use a larger spacing_m, or solver.backend: cpu");
}

void RawBuffer::bindStorage(uint32_t binding) const {
  requireBlock();
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, binding, id_);
}

void RawBuffer::bindUniform(uint32_t binding, size_t offset, size_t bytes) const {
  glBindBufferRange(GL_UNIFORM_BUFFER, binding, id_, static_cast<GLintptr>(offset), static_cast<GLsizeiptr>(bytes));
}

}  // namespace viscera::gpu
