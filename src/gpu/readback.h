// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace viscera::gpu {

/// The only asynchronous read-back from the GPU: a ring of persistently mapped buffers with fences. request() queues a
/// copy; collect() returns the oldest copy with a fence that has passed, in order of request.
class ReadbackRing {
 public:
  /// @param bytes  largest copy  @param depth  copies that may be in flight  @param name  for messages, a literal
  /// @param at_once  copies of buffers are made when they are queued, as by llvmpipe, which draws on threads of its
  /// own: they need not wait for drawing
  /// @throws GpuError  out of memory
  ReadbackRing(size_t bytes, int depth = 3, const char* name = "a copy", bool at_once = false);
  ~ReadbackRing();
  ReadbackRing(const ReadbackRing&) = delete;
  ReadbackRing& operator=(const ReadbackRing&) = delete;

  struct Source {
    uint32_t buffer;
    size_t offset, bytes;
  };
  /// Queues copies of the sources, one after the other, with a tag of the caller's. Returns false if every slot is in
  /// flight.
  bool request(const Source* sources, size_t count, uint64_t tag);
  bool request(const Source& source, uint64_t tag) { return request(&source, 1, tag); }
  /// Format in which a pixel is read.
  enum class Pixel { kRgb8, kFloat, kUint8 };
  /// Queues a copy of the bound read framebuffer's pixels, from its bottom row, packed without padding. Renderer draws
  /// the image's top row there, so rows arrive top first.
  bool requestPixels(int width, int height, uint64_t tag, Pixel pixel = Pixel::kRgb8);
  /// Returns the oldest finished copy, or nullptr. The memory stays valid until release(). @throws GpuError  it does
  /// not come
  const void* collect(uint64_t* tag, bool wait = false);
  void release();
  /// Discards what is in flight.
  void drop();
  int inFlight() const { return in_flight_; }
  uint64_t waits() const { return waits_; }  ///< times that collect() had to wait for the GPU

 private:
  struct Slot {
    uint32_t buffer = 0;
    void* memory = nullptr;
    void* fence = nullptr;
    uint64_t tag = 0;
  };
  Slot& claim(uint64_t tag);
  const char* name_;
  const bool at_once_;
  std::vector<Slot> slots_;
  int oldest_ = 0, in_flight_ = 0;
  uint64_t waits_ = 0;
};

}  // namespace viscera::gpu
