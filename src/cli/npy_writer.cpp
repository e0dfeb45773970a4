// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "cli/npy_writer.h"

#include <cstdint>

#include "export/png_writer.h"

namespace viscera {

static_assert(__BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__, "the header says little-endian");

void writeNpy(const std::string& path, int width, int height, const std::vector<float>& values) {
  constexpr size_t kLead = 10, kAlignment = 64;  // bytes of magic, version and length; alignment of the values
  std::string header = "{'descr': '<f4', 'fortran_order': False, 'shape': (" + std::to_string(height) + ", " +
                       std::to_string(width) + "), }";
  header.append(kAlignment - (kLead + header.size() + 1) % kAlignment, ' ');
  header += '\n';
  const auto length = static_cast<uint16_t>(header.size());
  std::string bytes = "\x93NUMPY";
  bytes += {'\x01', '\0', static_cast<char>(length & 255U), static_cast<char>(length >> 8U)};
  bytes += header;
  bytes.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(values[0]));
  writeImageFile(path, FileKind::kNpy, bytes);
}

}  // namespace viscera
