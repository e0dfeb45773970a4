// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>

#include "viscera/model/model.h"
#include "viscera/session/frame.h"
#include "viscera/solver/solver.h"

namespace viscera {

struct Scene;

namespace gpu {
class Context;
}

/// Viewing half of a session, separate from the stepping: surfaces and images on request (EGVE 3.3).
class View {
 public:
  virtual ~View() = default;
  /// Begins what is requested of the solver's current state, or skips it if too much is in flight.
  /// @param out  gets images that had to be taken to make room (FrameRequest::every_image)
  virtual void capture(Solver& solver, const RenderRequest& request, Pictures& out) = 0;
  /// Delivers what is ready: every image, the newest surface. @param wait  for everything that was begun
  virtual void collect(Pictures& out, bool wait) = 0;
  /// Makes the surfaces whole again. Nothing may be in flight.
  virtual void reset() = 0;
  virtual ViewCounters counters() const = 0;
  /// Returns the triangles of the uncut surface mesh.
  virtual std::shared_ptr<const VisibleTopology> wholeSkin() const = 0;
};

/// Makes a view: on this thread if the solver's state is on the GPU, which it must not leave; on a thread of its own if
/// it is on the host. Without a context: surfaces only, by HostView.
/// @param model  must outlive the view
/// @param context  current on this thread, and again once the view is gone; null: no OpenGL
std::unique_ptr<View> makeView(const Solver& solver, const Model& model, const Scene& scene, gpu::Context* context);

}  // namespace viscera
