// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "export/page/page_bytes.h"

#include <zlib.h>

#include <cstring>

#include "viscera/math/error.h"

namespace viscera {

void PageBytes::putFloat(float value) {
  uint32_t bits;
  std::memcpy(&bits, &value, sizeof bits);
  for (int shift = 0; shift < 32; shift += 8) putByte(static_cast<uint8_t>(bits >> shift));
}

std::string deflated(const std::string& bytes) {
  constexpr int kWindowBits = 15, kMemory = 9;  // the largest
  z_stream stream = {};
  if (deflateInit2(&stream, Z_BEST_COMPRESSION, Z_DEFLATED, kWindowBits, kMemory, Z_FILTERED) != Z_OK)
    throw Error("out of memory while compressing a page");
  std::string out(deflateBound(&stream, bytes.size()), '\0');
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data()));
  stream.avail_in = static_cast<uInt>(bytes.size());
  stream.next_out = reinterpret_cast<Bytef*>(out.data());
  stream.avail_out = static_cast<uInt>(out.size());
  deflate(&stream, Z_FINISH);  // the bound leaves room for all
  out.resize(stream.total_out);
  deflateEnd(&stream);
  return out;
}

}  // namespace viscera
