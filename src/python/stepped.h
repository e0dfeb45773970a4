// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <utility>

#include <pybind11/pybind11.h>

#include "python/scene_binding.h"
#include "viscera/gpu/context.h"
#include "viscera/math/error.h"
#include "viscera/session/session.h"

namespace viscera::python {

/// A session with what Python asks of it: calls from any thread, one at a time, after close() an error.
class Stepped {
 public:
  /// All that a call needs; lives on through a call in which another thread closes the session.
  struct Core {
    std::unique_ptr<gpu::Context> context;  ///< outlives the session
    std::unique_ptr<Session> session;
    Frame last;                              ///< of the newest tick; empty after a reset
    std::shared_ptr<const HostState> nodes;  ///< of now, once it was asked for
    std::mutex mutex;
    std::thread::id maker;
  };

  /// What reset() and restore() do, without the GIL and with the mutex held. @throws Error
  static void resetCore(Core& core);
  static void restoreCore(Core& core, const std::string& state);

  Stepped(const SceneSource& scene, const std::optional<std::string>& backend, int threads, bool pictures);
  /// Another door to a session.
  explicit Stepped(std::shared_ptr<Core> core) : core_(std::move(core)) {}
  ~Stepped() { close(); }
  void close();
  bool closed() const { return !core_; }

  /// Runs `work(core)` without the GIL, which it must not need, and hands on what it returns.
  /// @throws Error  the session is closed, or has OpenGL and another thread
  template <class Work>
  auto with(Work&& work) const {
    const std::shared_ptr<Core> core = core_;
    if (!core) throw Error("the session is closed");
    const pybind11::gil_scoped_release released;
    const std::lock_guard<std::mutex> lock(core->mutex);
    if (core->context && core->maker != std::this_thread::get_id())
      throw Error("a session with pictures or on the GPU is used by the thread that made it alone");
    return work(*core);
  }

  /// n ticks with the same hands; signals such as Ctrl-C are heard. @throws Error, and what Python's handlers raise
  void step(const StylusSamples& hands, int64_t ticks) const;
  void reset() const;
  /// A saved state as bytes. @throws Error
  std::string state() const;
  void restore(const std::string& state) const;
  std::shared_ptr<const HostState> nodes() const;
  /// The skin of now. @throws Error
  std::shared_ptr<const SurfaceFrame> skin() const;
  /// @throws Error  no pictures, no such camera, or this camera has none of this kind
  ImageFrame picture(size_t camera, PictureKind kind) const;

 private:
  std::shared_ptr<Core> core_;
};

}  // namespace viscera::python
