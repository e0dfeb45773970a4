// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "session/host_view.h"

#include <utility>

#include "viscera/math/error.h"

namespace viscera {

HostView::HostView(const Model& model) : surface_(model) {
  snapshot_.bricks = surface_.shownBricks();
}

void HostView::capture(Solver& solver, const Look& look, Pictures&) {
  if (look.wants.count() > static_cast<size_t>(look.wants.surface)) {
    throw GpuError(
        "an image is wanted of a session without an OpenGL context: give it one, or ask for its surface only");
  }
  if (!look.wants.surface) return;
  solver.snapshot(snapshot_);
  taken_ = std::make_unique<SurfaceFrame>();
  taken_->tick = look.tick;
  surface_.show(snapshot_, *taken_);
}

void HostView::collect(Pictures& out, bool) {
  if (taken_) out.surface = std::move(taken_);
}

ViewCounters HostView::counters() const {
  ViewCounters out;
  out.mappings = out.readbacks = surface_.mappings();
  if (const ShownWounds* const wounds = surface_.wounds()) {
    out.wound_holes = wounds->holes;
    out.wound_slivers = wounds->slivers;
  }
  return out;
}

}  // namespace viscera
