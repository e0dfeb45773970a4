// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "viscera/gpu/context.h"

#include <EGL/egl.h>
#include <EGL/eglext.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstring>

#include "gpu/gl.h"
#include "gpu/limits.h"
#include "gpu/software.h"
#include "viscera/math/error.h"

namespace viscera::gpu {

namespace {

constexpr int kMaxDevices = 32;

std::string eglFailure(const char* call) {
  char text[96];
  std::snprintf(text, sizeof text, "%s failed with EGL error 0x%04x", call, eglGetError());
  return text;
}

bool hasWord(const char* list, const char* word) {
  return list && std::strstr(list, word) != nullptr;
}

template <class F>
F eglFunction(const char* name) {
  return reinterpret_cast<F>(eglGetProcAddress(name));
}

/// Initialises a display, once in a process. Displays are never terminated: eglTerminate() would take it from all
/// users, and Mesa then unloads its driver and LLVM, while destructors of other threads may still use them.
/// @throws GpuError  this process was forked from one that had a display: drivers' threads and locks are not copied
bool openDisplay(EGLDisplay display) {
  static const pid_t opener = getpid();
  if (opener != getpid()) {
    throw GpuError(
        "OpenGL was first used by process " + std::to_string(opener) +
        ", from which this one was forked, and cannot be used in both. Start separate processes, in Python with "
        "multiprocessing.get_context(\"spawn\"), or step on the CPU without pictures");
  }
  return eglInitialize(display, nullptr, nullptr) == EGL_TRUE;
}

struct Candidate {
  int index;
  EGLDeviceEXT device;
  bool software;
  std::string name;
};

std::vector<Candidate> listDevices(std::string& problem) {
  const char* client = eglQueryString(EGL_NO_DISPLAY, EGL_EXTENSIONS);
  auto query_devices = eglFunction<PFNEGLQUERYDEVICESEXTPROC>("eglQueryDevicesEXT");
  auto query_string = eglFunction<PFNEGLQUERYDEVICESTRINGEXTPROC>("eglQueryDeviceStringEXT");
  if (!hasWord(client, "EGL_EXT_platform_device") || !query_devices || !query_string) {
    problem = "the EGL library has no EGL_EXT_platform_device / EGL_EXT_device_enumeration";
    return {};
  }
  EGLDeviceEXT devices[kMaxDevices];
  EGLint count = 0;
  if (!query_devices(kMaxDevices, devices, &count)) {
    problem = eglFailure("eglQueryDevicesEXT");
    return {};
  }
  if (count == 0) problem = "eglQueryDevicesEXT lists no device";
  std::vector<Candidate> out;
  for (int i = 0; i < count; ++i) {
    const char* extensions = query_string(devices[i], EGL_EXTENSIONS);
    const bool software = hasWord(extensions, "EGL_MESA_device_software");
    const char* file =
        hasWord(extensions, "EGL_EXT_device_drm") ? query_string(devices[i], EGL_DRM_DEVICE_FILE_EXT) : nullptr;
    std::string name = software ? "software rasteriser" : hasWord(extensions, "EGL_NV_device_cuda") ? "NVIDIA" : "GPU";
    if (file) name += std::string(" ") + file;
    out.push_back({i, devices[i], software, name});
  }
  std::stable_sort(out.begin(), out.end(),
                   [](const Candidate& a, const Candidate& b) { return a.software < b.software; });
  return out;
}

}  // namespace

Context::Context(int only) {
  std::string problem;
  for (const Candidate& candidate : listDevices(problem)) {
    DeviceAttempt attempt{candidate.index, candidate.name, false, ""};
    if (only >= 0 && candidate.index != only) {
      attempt.reason = "not requested: device " + std::to_string(only) + " was";
    } else if (!context_) {
      attempt.taken = open(candidate.index, candidate.device, attempt);
    } else {
      attempt.reason = "not needed: an earlier device was taken";
    }
    attempts_.push_back(attempt);
  }
  if (context_) return;
  std::string message = "no EGL device provides OpenGL 4.5 core";
  if (!problem.empty()) message += "; " + problem;
  for (const DeviceAttempt& a : attempts_) {
    message += "; device " + std::to_string(a.index) + " (" + a.name + "): " + a.reason;
  }
  throw GpuError(message);
}

namespace {

/// Creates a context. @param tells_of_resets  a reset of the GPU by the driver is then an error; without it results
/// stop changing
EGLContext createContext(EGLDisplay display, EGLConfig config, bool tells_of_resets) {
  std::vector<EGLint> wishes = {EGL_CONTEXT_MAJOR_VERSION,       4,
                                EGL_CONTEXT_MINOR_VERSION,       5,
                                EGL_CONTEXT_OPENGL_PROFILE_MASK, EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT};
  if (tells_of_resets)
    wishes.insert(wishes.end(), {EGL_CONTEXT_OPENGL_RESET_NOTIFICATION_STRATEGY, EGL_LOSE_CONTEXT_ON_RESET});
  wishes.push_back(EGL_NONE);
  return eglCreateContext(display, config, EGL_NO_CONTEXT, wishes.data());
}

/// Returns a current context on an initialised display; else EGL_NO_CONTEXT, with `reason` set.
EGLContext openContext(EGLDisplay display, std::string& reason) {
  const EGLint config_wishes[] = {EGL_SURFACE_TYPE, EGL_PBUFFER_BIT, EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT, EGL_NONE};
  EGLConfig config = nullptr;
  EGLint configs = 0;
  EGLContext context = EGL_NO_CONTEXT;
  if (!eglBindAPI(EGL_OPENGL_API)) {
    reason = eglFailure("eglBindAPI(EGL_OPENGL_API)");
  } else if (!eglChooseConfig(display, config_wishes, &config, 1, &configs) || configs == 0) {
    reason = eglFailure("eglChooseConfig");
  } else if ((context = createContext(display, config, true)) == EGL_NO_CONTEXT &&
             (context = createContext(display, config, false)) == EGL_NO_CONTEXT) {
    reason = eglFailure("eglCreateContext(OpenGL 4.5 core)");
  } else if (!eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, context)) {
    reason = eglFailure("eglMakeCurrent(no surface)");
    eglDestroyContext(display, context);
    context = EGL_NO_CONTEXT;
  }
  return context;
}

/// Loads the functions of the current context. @return the error; empty: none
std::string loadFunctions() {
  glewExperimental = GL_TRUE;
  const GLenum glew = glewInit();
  // GLEW 2.2 asks GLX for a display after it has loaded the entry points. On EGL there is none, which does no harm.
  if (glew != GLEW_OK && glew != GLEW_ERROR_NO_GLX_DISPLAY) {
    return std::string("glewInit failed: ") + reinterpret_cast<const char*>(glewGetErrorString(glew));
  }
  if (!glDispatchCompute || !glCreateBuffers || !glBufferStorage) return "the driver lacks OpenGL 4.5 entry points";
  while (glGetError() != GL_NO_ERROR) {
  }  // glewInit may leave GL_INVALID_ENUM behind on a core context
  recordErrors();
  // As many threads as the driver likes: all programs are started before any result is queried (gpu/program.h).
  if (glMaxShaderCompilerThreadsKHR) {
    glMaxShaderCompilerThreadsKHR(0xFFFFFFFF);
  } else if (glMaxShaderCompilerThreadsARB) {
    glMaxShaderCompilerThreadsARB(0xFFFFFFFF);
  }
  clearDriverLimits();
  try {
    requireLimits(driverLimits(), neededLimits());
  } catch (const GpuError& error) {
    return error.what();
  }
  return "";
}

}  // namespace

bool Context::open(int index, void* device, DeviceAttempt& attempt) {
  (void)index;
  auto platform_display = eglFunction<PFNEGLGETPLATFORMDISPLAYEXTPROC>("eglGetPlatformDisplayEXT");
  const EGLDisplay display =
      platform_display ? platform_display(EGL_PLATFORM_DEVICE_EXT, device, nullptr) : EGL_NO_DISPLAY;
  if (display == EGL_NO_DISPLAY) {
    attempt.reason = eglFailure("eglGetPlatformDisplayEXT");
    return false;
  }
  if (!openDisplay(display)) {
    attempt.reason = eglFailure("eglInitialize");
    return false;
  }
  const EGLContext context = openContext(display, attempt.reason);
  if (context == EGL_NO_CONTEXT) return false;
  attempt.reason = loadFunctions();
  if (!attempt.reason.empty()) {
    eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    eglDestroyContext(display, context);
    return false;
  }
  display_ = display;
  context_ = context;
  renderer_ = reinterpret_cast<const char*>(glGetString(GL_RENDERER));
  version_ = reinterpret_cast<const char*>(glGetString(GL_VERSION));
  software_ = gpu::isSoftware();
  attempt.name = renderer_;
  attempt.reason = software_ ? "first that works; no hardware device before it worked" : "first that works";
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  return true;
}

void Context::release() noexcept {
  if (isCurrent()) eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
}

bool Context::makeCurrent() noexcept {
  if (isCurrent()) return true;
  if (!eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, context_)) return false;
  clearDriverLimits();
  return true;
}

bool Context::isCurrent() const noexcept {
  eglBindAPI(EGL_OPENGL_API);  // EGL keeps this for each thread
  return eglGetCurrentContext() == context_;
}

void Context::requireCurrent() const {
  if (!isCurrent())
    throw GpuError(
        "the OpenGL context of this session is not current on this thread; call makeCurrent() of its gpu::Context, or "
        "hold a gpu::ContextScope, before each use of the session");
}

Context::~Context() {
  if (!context_) return;
  release();
  eglDestroyContext(display_, context_);
}

ContextScope::ContextScope() noexcept
    : api_(eglQueryAPI()),
      display_(eglGetCurrentDisplay()),
      context_(eglGetCurrentContext()),
      draw_(eglGetCurrentSurface(EGL_DRAW)),
      read_(eglGetCurrentSurface(EGL_READ)) {}

ContextScope::ContextScope(Context& context) : ContextScope() {
  if (!context.makeCurrent()) throw GpuError(eglFailure("eglMakeCurrent(the session's context)"));
}

ContextScope::~ContextScope() {
  eglBindAPI(EGL_OPENGL_API);
  const EGLDisplay display = eglGetCurrentDisplay();
  const bool changed = eglGetCurrentContext() != context_;
  if (changed && context_ == EGL_NO_CONTEXT) {
    eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
  }
  eglBindAPI(api_);
  if (changed && context_ != EGL_NO_CONTEXT) {
    eglMakeCurrent(display_, draw_, read_, context_);
    clearDriverLimits();
  }
}

}  // namespace viscera::gpu
