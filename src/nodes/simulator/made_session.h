// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <string>

#include "viscera/gpu/context.h"
#include "viscera/session/session.h"

namespace viscera::nodes {

/// A scene with what was made of it so far, on one thread for another one to go on with.
struct MadeSession {
  explicit MadeSession(const Scene& of) : scene(of) {}
  ~MadeSession();  ///< on any thread, once it was given up
  MadeSession(const MadeSession&) = delete;
  MadeSession& operator=(const MadeSession&) = delete;

  Scene scene;                            ///< with numbers in place of `spacing_m: auto` once there is a model
  std::shared_ptr<const Model> model;     ///< null: none yet
  std::unique_ptr<gpu::Context> context;  ///< which the session needs to its end; null: there is no OpenGL
  std::string no_context;                 ///< why there is none; empty: there is, or it was not looked for yet
  std::unique_ptr<Session> session;       ///< null: none yet

  /// Makes the model, while another simulator runs: on a thread that gives way to all others.
  /// @throws Error; what `progress` throws
  void makeModel(const Progress& progress);
  /// Makes what is not there yet. @throws Error; what `progress` throws
  void makeRest(const Progress& progress);
  /// The calling thread gives the session up, so that another one may take it.
  void give() const;
  /// The calling thread takes it. @throws GpuError
  void take() const;

 private:
  void makeContext();
};

}  // namespace viscera::nodes
