// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <deque>
#include <memory>
#include <optional>
#include <vector>

#include "gpu/readback.h"
#include "render/renderer.h"
#include "session/view.h"
#include "surface/surface.h"

namespace viscera {

/// A view that lives on the thread that made it: queues its work on the GPU and never waits for it unless asked to.
class InlineView : public View {
 public:
  /// Of solvers whose state is on the GPU. Needs a current context. @throws GpuError; SceneError  a camera without a
  /// line of sight
  InlineView(const Model& model, const Scene& scene);

  void capture(Solver& solver, const Look& look, Pictures& out) override;
  void capture(const StateView& state, const Look& look, Pictures& out);
  /// Wounds of the states that are captured from now on, see Surface::wound().
  void wound(const layout::NodeBits* nodes, const float* axial_cut, uint64_t revision);
  void collect(Pictures& out, bool wait) override;
  void reset() override;
  ViewCounters counters() const override;
  std::shared_ptr<const ShownTopology> wholeSkin() const override { return surface_.skin().whole(); }

 private:
  struct Drawn {  ///< what the last image of a camera shows, if it is known when the state moved
    uint32_t moved_revision = 0;
    uint64_t cut_revision = 0;
    ToolMotions motions;
    std::vector<Pose> obstacles;
    Overlays overlays;
    std::vector<Arrow> arrows;
  };
  struct Eye {
    CameraConfig camera;
    std::unique_ptr<gpu::ReadbackRing> ring;
    std::optional<Drawn> drawn;
  };
  void follow(const StateView& state);
  void captureSurface(const StateView& state, uint64_t tick);
  void captureImage(size_t camera, const StateView& state, const Look& look, Pictures& out);
  void draw(size_t camera, const StateView& state, const Look& look);
  bool takeImage(size_t camera, Pictures& out, bool wait);
  bool takeSurface(Pictures& out, bool wait);

  const Model& model_;
  Surface surface_;
  Renderer renderer_;
  CutState cuts_;
  std::unique_ptr<gpu::ReadbackRing> surface_ring_;
  std::deque<std::shared_ptr<const ShownWounds>> wounds_in_flight_;  ///< of the surfaces in the ring, oldest first
  std::vector<Eye> eyes_;                                            ///< [cameras]
  std::vector<uint32_t> alive_;                                      ///< of the surface taken last
  ViewCounters counters_;
  bool followed_ = false;  ///< the surface shows the state of this capture
};

}  // namespace viscera
