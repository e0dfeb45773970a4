// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstring>

#include "gpu/gl.h"

namespace viscera::gpu {

/// Returns whether the current context's OpenGL is a rasteriser on the processor.
inline bool isSoftware() {
  const auto* const name = reinterpret_cast<const char*>(glGetString(GL_RENDERER));
  return name != nullptr && (std::strstr(name, "llvmpipe") != nullptr || std::strstr(name, "softpipe") != nullptr);
}

}  // namespace viscera::gpu
