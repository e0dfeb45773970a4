// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "gpu/gl.h"

namespace viscera {

/// Returns pixels that are drawn and read back, and never sampled. The caller deletes it and checks for errors.
inline uint32_t makeRenderbuffer(GLenum format, int width, int height) {
  uint32_t id = 0;
  glCreateRenderbuffers(1, &id);
  gpu::countObject();
  glNamedRenderbufferStorage(id, format, width, height);
  return id;
}

}  // namespace viscera
