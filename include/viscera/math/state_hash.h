// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>

#include "viscera/api.h"

namespace VISCERA_PUBLIC viscera {

/// 64-bit FNV-1a hash of a stream of words, by which two runs are compared. Words are hashed in the order of the calls,
/// so callers pass nodes in the order of the active list.
class VISCERA_PUBLIC StateHash {
 public:
  void add(uint32_t word) {
    for (int byte = 0; byte < 4; ++byte) value_ = (value_ ^ ((word >> (8 * byte)) & 0xffu)) * kPrime;
  }
  void add(float value) {
    uint32_t bits;
    std::memcpy(&bits, &value, sizeof bits);
    add(bits);
  }
  uint64_t value() const { return value_; }

  /// Returns the hash as 16 lower-case hexadecimal digits.
  static std::string text(uint64_t hash);

 private:
  static constexpr uint64_t kPrime = 1099511628211ull;
  uint64_t value_ = 14695981039346656037ull;
};

inline std::string StateHash::text(uint64_t hash) {
  static const char* digits = "0123456789abcdef";
  std::string out(16, '0');
  for (int i = 0; i < 16; ++i) out[15 - i] = digits[(hash >> (4 * i)) & 0xfu];
  return out;
}

}  // namespace viscera
