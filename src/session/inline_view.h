// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <deque>
#include <memory>
#include <optional>
#include <vector>

#include "gpu/readback.h"
#include "render/renderer.h"
#include "session/seen_skin.h"
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
  /// @param displacements  of the same state, where it is on the host: then nothing waits to know what can be seen
  void capture(const StateView& state, const Look& look, Pictures& out,
               const std::optional<HostDisplacements>& displacements = {});
  /// Wounds of the states that are captured from now on, see Surface::wound().
  void wound(const CutSprings& cuts, uint64_t revision);
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
    SeenSkin skin;
    bool wanted = false, repeated = false;  ///< in this capture: is handed over, without being drawn
    std::optional<Drawn> drawn;
  };
  void captureSurface(uint64_t tick);
  void captureImage(size_t camera, const StateView& state, const Look& look);
  bool makeRoom(size_t camera, const Look& look, Pictures& out);
  bool isRepeat(size_t camera, const StateView& state, const Look& look) const;
  static Overlays overlaysOf(size_t camera, const Look& look);
  void follow(const StateView& state, bool all, const std::optional<HostDisplacements>& displacements);
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
  uint64_t captures_ = 0;
  SkinPlaces places_;
  std::vector<uint8_t> seen_;  ///< [groups] by any camera that is drawn
  SkinGroups::Needs needs_;
};

}  // namespace viscera
