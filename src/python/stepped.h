// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <unistd.h>

#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>

#include <pybind11/pybind11.h>

#include "python/scene_binding.h"
#include "viscera/gpu/context.h"
#include "viscera/math/error.h"
#include "viscera/session/session.h"

namespace viscera::python {

/// Process that something with threads or OpenGL was made in. fork() copies neither to the child.
class HomeProcess {
 public:
  bool isHere() const;
  /// @param what  for the message, such as "the session"   @throws Error  this process was forked from that one
  void require(const char* what) const;

 private:
  int id_ = getpid();
};

/// Makes a T that only the process that made it destroys: a forked one would wait for threads that it does not have.
template <class T>
std::shared_ptr<T> makeHere() {
  return {new T, [home = HomeProcess()](T* made) {
            if (home.isHere()) delete made;
          }};
}

/// A session with what Python asks of it: calls from any thread, one at a time, after close() an error.
class Stepped {
 public:
  /// All that a call needs; lives on through a call in which another thread closes the session. Of makeHere().
  struct Core {
    std::unique_ptr<gpu::Context> context;  ///< outlives the session
    std::unique_ptr<Session> session;
    Frame last;                              ///< of the newest tick; empty after a reset
    std::shared_ptr<const HostState> nodes;  ///< of now, once it was asked for
    std::recursive_mutex mutex;              ///< signal handlers of Python use the session within step()
    HomeProcess home;

    ~Core();
    /// Returns whether calls need the context on their own thread; a view on a thread of its own keeps it otherwise.
    bool callsNeedContext() const { return context && session && !session->solver().onHost(); }
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

  /// Runs `work(core)` without the GIL, which it must not need, and hands on what it returns. The session's context is
  /// current meanwhile, if it has one, and then the former one again.
  /// @throws Error  the session is closed, or of a process that this one was forked from
  template <class Work>
  auto with(Work&& work) const {
    const std::shared_ptr<Core> core = core_;
    if (!core) throw Error("the session is closed");
    core->home.require("the session");
    const pybind11::gil_scoped_release released;
    const std::lock_guard<std::recursive_mutex> lock(core->mutex);
    std::optional<gpu::ContextScope> current;
    if (core->callsNeedContext()) current.emplace(*core->context);
    return work(*core);
  }

  /// n ticks with the same hands; signals such as Ctrl-C are heard, and their handlers may use the session.
  /// @throws Error, and what Python's handlers raise
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
  void hearSignals(const Core& core) const;

  std::shared_ptr<Core> core_;
};

}  // namespace viscera::python
