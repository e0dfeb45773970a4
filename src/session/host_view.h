// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>

#include "session/view.h"
#include "surface/follow/host_surface.h"

namespace viscera {

/// View without OpenGL, on the stepping thread: surfaces at once, no images.
class HostView : public View {
 public:
  explicit HostView(const Model& model);

  /// @throws GpuError  an image is requested
  void capture(Solver& solver, const RenderRequest& request, Pictures& out) override;
  void collect(Pictures& out, bool wait) override;
  void reset() override { surface_.reset(); }
  ViewCounters counters() const override;
  std::shared_ptr<const VisibleTopology> wholeSkin() const override { return surface_.skin().whole(); }

 private:
  HostSurface surface_;
  StateSnapshot snapshot_;
  std::unique_ptr<SurfaceFrame> taken_;  ///< of the last capture, until it is collected
};

}  // namespace viscera
