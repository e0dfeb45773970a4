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
  uLongf size = compressBound(bytes.size());
  std::string out(size, '\0');
  if (compress2(reinterpret_cast<Bytef*>(out.data()), &size, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size(),
                Z_BEST_COMPRESSION) != Z_OK)
    throw Error("out of memory while compressing a page");
  out.resize(size);
  return out;
}

}  // namespace viscera
