// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "gpu/gl.h"

#include <atomic>
#include <cstdio>
#include <cstring>
#include <mutex>

#include "gpu/program.h"
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
    case GL_CONTEXT_LOST:
      return std::string(hex) + " (GL_CONTEXT_LOST)";
    default:
      return hex;
  }
}

namespace {

std::mutex said_mutex;
std::string said;  ///< the driver's last message of an error

void GLAPIENTRY note(GLenum, GLenum type, GLuint, GLenum, GLsizei length, const GLchar* text, const void*) {
  if (type != GL_DEBUG_TYPE_ERROR) return;
  const std::lock_guard<std::mutex> lock(said_mutex);
  said.assign(text, length < 0 ? std::strlen(text) : static_cast<size_t>(length));
}

std::string takeSaid() {
  const std::lock_guard<std::mutex> lock(said_mutex);
  std::string out;
  out.swap(said);
  return out;
}

}  // namespace

void recordErrors() {
  glEnable(GL_DEBUG_OUTPUT);
  glDebugMessageControl(GL_DONT_CARE, GL_DONT_CARE, GL_DONT_CARE, 0, nullptr, GL_FALSE);
  glDebugMessageControl(GL_DONT_CARE, GL_DEBUG_TYPE_ERROR, GL_DONT_CARE, 0, nullptr, GL_TRUE);
  glDebugMessageCallback(note, nullptr);
}

void requireNoReset(unsigned status, const char* what) {
  if (status == GL_NO_ERROR) return;
  const char* guilt = status == GL_GUILTY_CONTEXT_RESET     ? "because of commands of this program"
                      : status == GL_INNOCENT_CONTEXT_RESET ? "because of another program"
                                                            : "for an unknown reason";
  throw GpuError(std::string("the driver has reset the GPU, ") + guilt + ": the context and its memory are lost, in " +
                 what + ", last kernel '" + lastKernel() + "'. Restart the program, or use solver.backend: cpu");
}

void checkErrors(const char* what) {
  const GLenum code = glGetError();
  if (code == GL_NO_ERROR || code == GL_CONTEXT_LOST)
    requireNoReset(glGetGraphicsResetStatus ? glGetGraphicsResetStatus() : GL_NO_ERROR, what);
  if (code == GL_NO_ERROR) return;
  const std::string more = takeSaid();
  throw GpuError(std::string("OpenGL error ") + glErrorText(code) + " in " + what +
                 (more.empty() ? "" : "; the driver says: " + more));
}

}  // namespace viscera::gpu
