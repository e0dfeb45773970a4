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

/// The viewing half of a session: skin and images for those who want them (EGVE 3.3), beside the stepping.
class View {
 public:
  virtual ~View() = default;
  /// Begins what is wanted of the solver's current state, or skips it if too much is under way.
  /// @param out  gets images that had to be taken to make room (Wants::every_image)
  virtual void capture(Solver& solver, const Look& look, Pictures& out) = 0;
  /// Hands over what is ready: every image, the newest surface. @param wait  for all that was begun
  virtual void collect(Pictures& out, bool wait) = 0;
  /// Skins whole again. Nothing may be under way.
  virtual void reset() = 0;
  virtual ViewCounters counters() const = 0;
  /// Triangles of the skin as long as nothing is cut.
  virtual std::shared_ptr<const ShownTopology> wholeSkin() const = 0;
};

/// On this thread if the solver's state is on the GPU, which it must not leave; on one of its own if it is on the host.
/// Without a context: the skin only, by HostView.
/// @param model  must outlive the view
/// @param context  current on this thread, and again when the view is gone; null: there is none
std::unique_ptr<View> makeView(const Solver& solver, const Model& model, const Scene& scene, gpu::Context* context);

}  // namespace viscera
