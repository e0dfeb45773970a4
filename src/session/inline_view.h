// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "gpu/fence.h"
#include "gpu/readback.h"
#include "render/renderer.h"
#include "session/seen_skin.h"
#include "session/view.h"
#include "surface/overlay/node_overlay.h"
#include "surface/overlay/pale_skin.h"
#include "surface/surface.h"

namespace viscera {

struct Scene;

/// @returns  the size of a picture that a camera sends [bytes]
inline size_t pictureBytes(const CameraConfig& camera, PictureKind kind) {
  const size_t of_pixel = kind == PictureKind::kDepth ? sizeof(float) : kind == PictureKind::kLabels ? 1 : 3;
  return of_pixel * static_cast<size_t>(camera.width_px) * static_cast<size_t>(camera.height_px);
}

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
  /// Of the next capture of images: is called while the last of them is drawn, whenever nothing needs the surface any
  /// more: showSurface() may be called then. Empty: nothing is.
  void setPause(std::function<void()> pause) { pause_ = std::move(pause); }
  /// Maps and hands over the surface alone, of a state that wound() knows.
  void showSurface(const StateView& state, const Look& look, Pictures& out);
  /// Wounds of the states that are captured from now on, see Surface::wound().
  void wound(const CutSprings& cuts, uint64_t revision);
  void collect(Pictures& out, bool wait) override;
  /// Is anything on its way that collect() has not handed over?
  bool anyUnderWay() const;
  void reset() override;
  ViewCounters counters() const override;
  std::shared_ptr<const ShownTopology> wholeSkin() const override { return surface_.skin().whole(); }

 private:
  struct Drawn {  ///< what the last image of a camera shows, if it is known when the state moved
    uint32_t moved_revision = 0;
    uint64_t cut_revision = 0;
    ToolMotions motions;
    std::vector<Pose> obstacles;
    Pose pose;  ///< of the optical frame
    Overlays overlays;
    std::vector<Arrow> arrows;
    ProcessLook processes;
  };
  struct Channel {  ///< one kind of picture of an eye, on its way
    PictureKind kind = PictureKind::kColor;
    std::unique_ptr<gpu::ReadbackRing> ring;  ///< null until one is wanted
    bool wanted = false;                      ///< in this capture: is handed over
    std::unique_ptr<gpu::Fence> drawn = {};   ///< of a picture that is read when it is drawn; null: there is none
    uint64_t drawn_tick = 0;
  };
  struct Eye {
    size_t camera;
    CameraConfig config;  ///< of the camera; what differs in the right eye is its pose
    SeenSkin skin;
    Pose pose;                             ///< of the optical frame in this capture, tissue frame
    Channel color, depth, labels;          ///< a right eye has the first
    std::optional<Drawn> drawn;            ///< the last picture
    std::optional<Drawn> measured;         ///< the last depths and labels
    bool draws = false, measures = false;  ///< in this capture, as the last ones will not do
  };
  void addEye(size_t camera, const CameraConfig& config, PictureKind kind);
  void captureSurface(const StateView& state, const Look& look);
  void place(size_t eye, const Look& look);
  void choose(size_t eye, const StateView& state, const Look& look, Pictures& out);
  void captureImage(size_t eye, const StateView& state, const Look& look);
  void captureGeometry(size_t eye, const StateView& state, const Look& look);
  bool claim(Channel& channel, Eye& eye, const Look& look, Pictures& out);
  bool isRepeat(const Eye& eye, const std::optional<Drawn>& drawn, const Overlays& overlays, const StateView& state,
                const Look& look) const;
  static Overlays overlaysOf(size_t camera, const Look& look);
  void follow(const StateView& state, bool all, const std::optional<HostDisplacements>& displacements);
  void draw(size_t eye, const StateView& state, const Look& look);
  void request(Channel& channel, const Eye& eye, uint64_t tick);
  void readDrawn(Channel& channel, const Eye& eye);
  bool takeImage(Channel& channel, const Eye& eye, Pictures& out, bool wait);
  bool takeSurface(Pictures& out, bool wait);

  const Model& model_;
  Surface surface_;
  std::unique_ptr<PaleSkin> pale_skin_;  ///< null where no body blanches
  Renderer renderer_;
  CutState cuts_;
  std::unique_ptr<gpu::ReadbackRing> surface_ring_;
  struct Sent {  ///< what a surface in the ring has
    std::shared_ptr<const ShownWounds> wounds;
    bool colors, strain;
  };
  std::deque<Sent> in_flight_;           ///< oldest first
  std::unique_ptr<NodeOverlay> strain_;  ///< of surfaces; null until one is wanted with it
  const double strain_range_;
  std::vector<Eye> eyes_;        ///< those of cameras in their order, then right ones
  std::vector<uint32_t> alive_;  ///< of the surface taken last
  ViewCounters counters_;
  uint64_t captures_ = 0;
  std::function<void()> pause_;
  const bool reads_late_;  ///< reading would wait on this thread
};

}  // namespace viscera
