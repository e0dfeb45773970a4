// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "gpu/readback.h"

#include <cassert>

#include "gpu/fence.h"
#include "gpu/gl.h"
#include "viscera/math/error.h"

namespace viscera::gpu {

ReadbackRing::ReadbackRing(size_t bytes, int depth, const char* name, bool at_once)
    : name_(name), at_once_(at_once), slots_(static_cast<size_t>(depth)) {
  const GLbitfield flags = GL_MAP_READ_BIT | GL_MAP_PERSISTENT_BIT | GL_MAP_COHERENT_BIT;
  for (Slot& slot : slots_) {
    glCreateBuffers(1, &slot.buffer);
    countObject();
    glNamedBufferStorage(slot.buffer, static_cast<GLsizeiptr>(bytes), nullptr, flags | GL_CLIENT_STORAGE_BIT);
    slot.memory = glMapNamedBufferRange(slot.buffer, 0, static_cast<GLsizeiptr>(bytes), flags);
    const GLenum code = glGetError();
    if (!slot.memory || code != GL_NO_ERROR) {
      throw GpuError(std::string("no memory to read ") + name + " back, " + std::to_string(bytes) +
                     " bytes: " + glErrorText(code));
    }
  }
}

ReadbackRing::~ReadbackRing() {
  for (Slot& slot : slots_) {
    if (slot.fence) glDeleteSync(static_cast<GLsync>(slot.fence));
    if (slot.buffer) glDeleteBuffers(1, &slot.buffer);
  }
}

ReadbackRing::Slot& ReadbackRing::claim(uint64_t tag) {
  Slot& slot = slots_[static_cast<size_t>(oldest_ + in_flight_) % slots_.size()];
  slot.tag = tag;
  ++in_flight_;
  return slot;
}

bool ReadbackRing::request(const Source* sources, size_t count, uint64_t tag) {
  if (in_flight_ == static_cast<int>(slots_.size())) return false;
  Slot& slot = claim(tag);
  glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
  GLintptr at = 0;
  for (const Source* s = sources; s != sources + count; ++s) {
    glCopyNamedBufferSubData(s->buffer, slot.buffer, static_cast<GLintptr>(s->offset), at,
                             static_cast<GLsizeiptr>(s->bytes));
    at += static_cast<GLintptr>(s->bytes);
  }
  glMemoryBarrier(GL_CLIENT_MAPPED_BUFFER_BARRIER_BIT);
  if (at_once_) {
    (void)glIsBuffer(slot.buffer);  // a query with an answer: where the driver queues calls, they have been made now
  } else {
    slot.fence = glFenceSync(GL_SYNC_GPU_COMMANDS_COMPLETE, 0);
  }
  return true;
}

bool ReadbackRing::requestPixels(int width, int height, uint64_t tag, Pixel pixel) {
  if (in_flight_ == static_cast<int>(slots_.size())) return false;
  Slot& slot = claim(tag);
  glBindBuffer(GL_PIXEL_PACK_BUFFER, slot.buffer);
  const GLenum format = pixel == Pixel::kRgb8 ? GL_RGB : pixel == Pixel::kFloat ? GL_RED : GL_RED_INTEGER;
  glReadPixels(0, 0, width, height, format, pixel == Pixel::kFloat ? GL_FLOAT : GL_UNSIGNED_BYTE, nullptr);
  glBindBuffer(GL_PIXEL_PACK_BUFFER, 0);
  glMemoryBarrier(GL_CLIENT_MAPPED_BUFFER_BARRIER_BIT);
  slot.fence = glFenceSync(GL_SYNC_GPU_COMMANDS_COMPLETE, 0);
  return true;
}

const void* ReadbackRing::collect(uint64_t* tag, bool wait) {
  if (in_flight_ == 0) return nullptr;
  Slot& slot = slots_[static_cast<size_t>(oldest_)];
  if (slot.fence) {
    const GLsync fence = static_cast<GLsync>(slot.fence);
    const GLenum result = glClientWaitSync(fence, GL_SYNC_FLUSH_COMMANDS_BIT, 0);
    if (result == GL_WAIT_FAILED) throw GpuError("glClientWaitSync failed: " + glErrorText(glGetError()));
    if (result == GL_TIMEOUT_EXPIRED) {
      if (!wait) return nullptr;
      ++waits_;
      awaitSync(fence, name_);
    }
    glDeleteSync(fence);
    slot.fence = nullptr;
  }
  if (tag) *tag = slot.tag;
  return slot.memory;
}

void ReadbackRing::release() {
  assert(in_flight_ > 0);
  oldest_ = (oldest_ + 1) % static_cast<int>(slots_.size());
  --in_flight_;
}

void ReadbackRing::drop() {
  while (collect(nullptr, true)) release();
}

}  // namespace viscera::gpu
