// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>

namespace viscera {

/// Bytes of a block of a page (page_writer.h), little-endian on every machine.
class PageBytes {
 public:
  void putByte(uint8_t value) { bytes_ += static_cast<char>(value); }
  /// Appends a number of at most 32 bits, seven bits per byte, the lowest first. All bytes but the last have the high
  /// bit.
  void putCount(uint32_t value) {
    for (; value > 127; value >>= 7) putByte(static_cast<uint8_t>(value | 128));
    putByte(static_cast<uint8_t>(value));
  }
  /// Appends a signed number, with its sign in the lowest bit: 0, -1, 1, -2 are stored as 0, 1, 2, 3.
  void putSigned(int32_t value) {
    const uint32_t bits = static_cast<uint32_t>(value);
    putCount(bits << 1 ^ (value < 0 ? ~0u : 0u));
  }
  void putFloat(float value);
  const std::string& text() const { return bytes_; }
  void clear() { bytes_.clear(); }

 private:
  std::string bytes_;
};

/// Returns bytes compressed in the format of zlib (RFC 1950). @throws Error  out of memory
std::string deflated(const std::string& bytes);

}  // namespace viscera
