// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "session/host_view.h"

#include <utility>

#include "viscera/math/error.h"

namespace viscera {

HostView::HostView(const Model& model) : surface_(model) {
  snapshot_.bricks = surface_.shownBricks();
}

void HostView::capture(Solver& solver, const RenderRequest& request, Pictures&) {
  if (request.outputs.count() > static_cast<size_t>(request.outputs.surface)) {
    throw GpuError(
        "an image was requested from a session without an OpenGL context; create one, or request only the surface");
  }
  if (!request.outputs.surface) return;
  solver.snapshot(snapshot_);
  taken_ = std::make_unique<SurfaceFrame>();
  taken_->tick = request.tick;
  surface_.show(snapshot_, *taken_);
}

void HostView::collect(Pictures& out, bool) {
  if (taken_) out.surface = std::move(taken_);
}

ViewCounters HostView::counters() const {
  ViewCounters out;
  out.mappings = out.readbacks = surface_.mappings();
  if (const VisibleWounds* const wounds = surface_.wounds()) {
    out.wound_holes = wounds->holes;
    out.wound_slivers = wounds->slivers;
  }
  return out;
}

}  // namespace viscera
