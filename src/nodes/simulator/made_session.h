// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <string>

#include "viscera/gpu/context.h"
#include "viscera/session/session.h"

namespace viscera::nodes {

/// A scene with what has been created for it so far. One thread creates it and another thread may continue.
struct MadeSession {
  explicit MadeSession(const Scene& of) : scene(of) {}
  ~MadeSession();  ///< runs on any thread, after give()
  MadeSession(const MadeSession&) = delete;
  MadeSession& operator=(const MadeSession&) = delete;

  Scene scene;                            ///< scene; with numbers instead of `spacing_m: auto` once there is a model
  std::shared_ptr<const Model> model;     ///< model; null: not created yet
  std::unique_ptr<gpu::Context> context;  ///< context, which the session needs until its end; null: no OpenGL
  std::string no_context;                 ///< reason why there is no context; empty: there is one, or not yet
  std::unique_ptr<Session> session;       ///< session; null: not created yet

  /// Creates the model while another simulator runs, on a thread of low priority.
  /// @throws Error; exceptions of `progress`
  void makeModel(const Progress& progress);
  /// Creates what does not exist yet. @throws Error; exceptions of `progress`
  void makeRest(const Progress& progress);
  /// Releases the session from the calling thread, so that another thread may take it.
  void give() const;
  /// Makes the session current on the calling thread. @throws GpuError
  void take() const;

 private:
  void makeContext();
};

}  // namespace viscera::nodes
