// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "viscera/gpu/context.h"
#include "viscera/model/model.h"
#include "viscera/session/frame.h"
#include "viscera/solver/solver.h"
#include "viscera/surface/surface.h"

namespace viscera {

/// A tick that is to be looked at.
struct Look {
  uint64_t tick = 0;
  ToolMotions motions;
  std::vector<Pose> obstacles;  ///< [obstacles] at the end of the tick, tissue frame
  Wants wants;
};

/// Work done for the eye since the start: with no subscriber all stay zero.
struct ViewCounters {
  uint64_t mappings = 0;      ///< times that vertices were brought to the nodes
  uint64_t renders = 0;       ///< images drawn
  uint64_t readbacks = 0;     ///< surfaces and images handed over
  uint64_t repeats = 0;       ///< ... images of these that were not drawn again: nothing had changed
  uint64_t skipped = 0;       ///< surfaces and images that were wanted and overtaken, as too many were under way
  uint64_t moved_bricks = 0;  ///< bricks that had changed when a state on the host was brought to the GPU
};

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
  /// Its sizes and indices; its buffers are the view's.
  virtual const Surface& surface() const = 0;
};

/// On this thread if the solver's state is on the GPU, which it must not leave; on one of its own if it is on the host.
/// @param model  must outlive the view   @param context  current on this thread, and again when the view is gone
std::unique_ptr<View> makeView(const Solver& solver, const Model& model, const Scene& scene, gpu::Context& context);

}  // namespace viscera
