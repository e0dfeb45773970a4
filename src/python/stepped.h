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

/// The process in which an object with threads or OpenGL was created. fork() copies neither to the child.
class HomeProcess {
 public:
  bool isHere() const;
  /// Checks that this is the process.
  /// @param what  for the message, such as "the session"   @throws Error  this process was forked from it
  void require(const char* what) const;

 private:
  int id_ = getpid();
};

/// Creates a T that only the creating process destroys: a forked one would wait for threads that it does not have.
template <class T>
std::shared_ptr<T> makeHere() {
  return {new T, [home = HomeProcess()](T* made) {
            if (home.isHere()) delete made;
          }};
}

/// A session for Python: any thread may call, one at a time; after close() calls fail.
class Stepped {
 public:
  /// The data of a call; it stays alive in a call during which another thread closes the session. Created by
  /// makeHere().
  struct Core {
    std::unique_ptr<gpu::Context> context;  ///< must outlive the session
    std::unique_ptr<Session> session;
    Frame last;                              ///< frame of the newest tick; empty after a reset
    std::shared_ptr<const HostState> nodes;  ///< current state, after it was requested
    std::recursive_mutex mutex;              ///< recursive: signal handlers may use the session in step()
    HomeProcess home;

    ~Core();
    /// Returns whether calls need the context on their own thread; otherwise a view with its own thread has it.
    bool callsNeedContext() const { return context && session && !session->solver().onHost(); }
  };

  /// Implements reset() and restore(), without the GIL and with the mutex held. @throws Error
  static void resetCore(Core& core);
  static void restoreCore(Core& core, const std::string& state);

  Stepped(const SceneSource& scene, const std::optional<std::string>& backend, int threads, bool pictures);
  /// Wraps the core of an existing session.
  explicit Stepped(std::shared_ptr<Core> core) : core_(std::move(core)) {}
  ~Stepped() { close(); }
  void close();
  bool closed() const { return !core_; }

  /// Runs `work(core)` without the GIL and returns its result. The session's context, if it has one, is current during
  /// the call; afterwards the previous one is.
  /// @throws Error  the session is closed, or belongs to a process from which this one was forked
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

  /// Steps n ticks with the same samples. Handles signals such as Ctrl-C; their handlers may use the session.
  /// @throws Error, and exceptions of Python's handlers
  void step(const StylusSamples& samples, int64_t ticks) const;
  void reset() const;
  /// Returns a saved state as bytes. @throws Error
  std::string state() const;
  void restore(const std::string& state) const;
  std::shared_ptr<const HostState> nodes() const;
  /// Returns the current surface mesh. @throws Error
  std::shared_ptr<const SurfaceFrame> skin() const;
  /// Returns an image. @throws Error  there are no images, no such camera, or it has no image of this kind
  ImageFrame picture(size_t camera, PictureKind kind) const;

 private:
  void hearSignals(const Core& core) const;

  std::shared_ptr<Core> core_;
};

}  // namespace viscera::python
