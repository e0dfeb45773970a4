// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "gpu/gl.h"

#include <atomic>
#include <cstdio>

#include "viscera/gpu/context.h"
#include "viscera/math/error.h"

namespace viscera::gpu {

namespace {
std::atomic<size_t> objects_created{0};
}

void countObject() {
  ++objects_created;
}
size_t objectsCreated() {
  return objects_created;
}

std::string glErrorText(unsigned code) {
  char hex[16];
  std::snprintf(hex, sizeof hex, "0x%04x", code);
  switch (code) {
    case GL_INVALID_ENUM:
      return std::string(hex) + " (GL_INVALID_ENUM)";
    case GL_INVALID_VALUE:
      return std::string(hex) + " (GL_INVALID_VALUE)";
    case GL_INVALID_OPERATION:
      return std::string(hex) + " (GL_INVALID_OPERATION)";
    case GL_INVALID_FRAMEBUFFER_OPERATION:
      return std::string(hex) + " (GL_INVALID_FRAMEBUFFER_OPERATION)";
    case GL_OUT_OF_MEMORY:
      return std::string(hex) + " (GL_OUT_OF_MEMORY)";
    default:
      return hex;
  }
}

void checkErrors(const char* what) {
  const GLenum code = glGetError();
  if (code != GL_NO_ERROR) throw GpuError(std::string("OpenGL error ") + glErrorText(code) + " in " + what);
}

}  // namespace viscera::gpu
