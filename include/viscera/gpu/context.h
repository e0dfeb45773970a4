// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "viscera/api.h"

namespace VISCERA_PUBLIC viscera {
namespace gpu {

/// One EGL device that was tried, and the result.
struct DeviceAttempt {
  int index = 0;
  std::string name;
  bool taken = false;
  std::string reason;  ///< why it was chosen, or the call and code that failed
};

/// Headless OpenGL 4.5 core context through EGL, current on the thread that made it until another thread takes it.
/// Needs no display.
class VISCERA_PUBLIC Context {
 public:
  /// Tries the EGL devices in turn (hardware before software), or only device `only` if it is >= 0.
  /// @throws GpuError naming every device and why it failed
  explicit Context(int only = -1);
  ~Context();
  Context(const Context&) = delete;
  Context& operator=(const Context&) = delete;

  /// Releases the context on the calling thread, if it is current there; another thread may then take it.
  void release() noexcept;
  /// Makes the context current on the calling thread. Returns false if EGL refuses, as while another thread has it.
  [[nodiscard]] bool makeCurrent() noexcept;
  /// Returns whether the context is current on the calling thread.
  bool isCurrent() const noexcept;
  /// Checks that the context is current. @throws GpuError  it is not current on the calling thread, where OpenGL would
  /// work on another context's objects
  void requireCurrent() const;

  const std::string& renderer() const { return renderer_; }
  const std::string& version() const { return version_; }
  bool isSoftware() const { return software_; }
  const std::vector<DeviceAttempt>& attempts() const { return attempts_; }

 private:
  bool open(int index, void* device, DeviceAttempt& attempt);

  void* display_ = nullptr;
  void* context_ = nullptr;
  std::string renderer_, version_;
  bool software_ = false;
  std::vector<DeviceAttempt> attempts_;
};

/// Scope that restores, at its end, the context that was current on this thread at its beginning, of any library, or
/// none.
class VISCERA_PUBLIC ContextScope {
 public:
  ContextScope() noexcept;
  /// Makes `context` current until the end of the scope. @throws GpuError  EGL refuses, as while another thread has it
  explicit ContextScope(Context& context);
  ~ContextScope();
  ContextScope(const ContextScope&) = delete;
  ContextScope& operator=(const ContextScope&) = delete;

 private:
  unsigned api_;
  void *display_, *context_, *draw_, *read_;
};

/// Checks for OpenGL errors. @throws GpuError if OpenGL has an error pending; `what` names the work just done
void checkErrors(const char* what);

/// Returns the number of OpenGL objects made since the process began; the hot loop must not change it.
size_t objectsCreated();

}  // namespace gpu
}  // namespace viscera
