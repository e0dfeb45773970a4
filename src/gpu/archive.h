// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "gpu/buffer.h"
#include "math/archive.h"

namespace viscera::gpu {

/// Writes a buffer into an archive, or reads it. Waits for the GPU.
template <class T>
void persist(Archive& archive, Buffer<T>& buffer) {
  std::vector<T> values;
  if (archive.reads()) {
    values.resize(buffer.size());
  } else {
    values = buffer.read();
  }
  archive.values(values);
  if (archive.reads()) buffer.write(values);
}
inline void persist(Archive& archive, RawBuffer& buffer) {
  std::vector<char> bytes(buffer.bytes());
  if (!archive.reads() && !bytes.empty()) buffer.read(0, bytes.size(), bytes.data());
  archive.values(bytes);
  if (archive.reads() && !bytes.empty()) buffer.write(0, bytes.size(), bytes.data());
}

}  // namespace viscera::gpu
