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
#include "session/skin_visibility.h"
#include "session/view.h"
#include "surface/overlay/blanching.h"
#include "surface/overlay/node_overlay.h"
#include "surface/surface.h"

namespace viscera {

struct Scene;

/// Returns the size of an image of a camera [bytes].
inline size_t pictureBytes(const CameraConfig& camera, PictureKind kind) {
  const size_t of_pixel = kind == PictureKind::kDepth ? sizeof(float) : kind == PictureKind::kLabels ? 1 : 3;
  return of_pixel * static_cast<size_t>(camera.width_px) * static_cast<size_t>(camera.height_px);
}

/// View on the thread that made it: queues its work on the GPU and waits for it only on request.
class InlineView : public View {
 public:
  /// For solvers with their state on the GPU. Needs a current context. @throws GpuError; SceneError  a camera without a
  /// line of sight
  InlineView(const Model& model, const Scene& scene);

  void capture(Solver& solver, const RenderRequest& request, Pictures& out) override;
  /// @param displacements  of the same state, where it is on the host: visibility then needs no wait
  void capture(const StateView& state, const RenderRequest& request, Pictures& out,
               const std::optional<HostDisplacements>& displacements = {});
  /// Sets a callback for the next capture of images. It is called while the last of them is drawn, at times when
  /// nothing needs the surface and showSurface() may be called. Empty: no callback.
  void setPause(std::function<void()> pause) { pause_ = std::move(pause); }
  /// Maps and delivers only the surface, for a state that wound() knows.
  void showSurface(const StateView& state, const RenderRequest& request, Pictures& out);
  /// Sets the wounds of the states that are captured from now on, see Surface::wound().
  void wound(const CutSprings& cuts, uint64_t revision);
  void collect(Pictures& out, bool wait) override;
  /// Returns whether something is in flight that collect() has not delivered.
  bool anyInFlight() const;
  void reset() override;
  ViewCounters counters() const override;
  std::shared_ptr<const VisibleTopology> wholeSkin() const override { return surface_.skin().whole(); }

 private:
  struct Drawn {  ///< content of the last image of a camera, where the revision of the state is known
    uint32_t moved_revision = 0;
    uint64_t cut_revision = 0;
    ToolMotions motions;
    std::vector<Pose> obstacles;
    Pose pose;  ///< pose of the optical frame
    Overlays overlays;
    std::vector<Arrow> arrows;
    ProcessVisuals processes;
    std::shared_ptr<const VisibleMarks> marks;
  };
  struct Channel {  ///< one kind of image of an eye, in flight
    PictureKind kind = PictureKind::kColor;
    std::unique_ptr<gpu::ReadbackRing> ring;  ///< null until one is requested
    bool wanted = false;                      ///< requested in this capture
    std::unique_ptr<gpu::Fence> drawn = {};   ///< of an image that is read once it is drawn; null: there is none
    uint64_t drawn_tick = 0;
  };
  struct Eye {
    size_t camera;
    CameraConfig config;  ///< of the camera; a right eye differs in its pose only
    SkinVisibility skin;
    Pose pose;                             ///< pose of the optical frame in this capture, tissue frame
    Channel color, depth, labels;          ///< a right eye has only the first
    std::optional<Drawn> drawn;            ///< the last image
    std::optional<Drawn> measured;         ///< the last depths and labels
    bool draws = false, measures = false;  ///< in this capture, as the last ones are out of date
  };
  void addEye(size_t camera, const CameraConfig& config, PictureKind kind);
  void captureSurface(const StateView& state, const RenderRequest& request);
  void place(size_t eye, const RenderRequest& request);
  void choose(size_t eye, const StateView& state, const RenderRequest& request, Pictures& out);
  void captureImage(size_t eye, const StateView& state, const RenderRequest& request);
  void captureGeometry(size_t eye, const StateView& state, const RenderRequest& request);
  bool claim(Channel& channel, Eye& eye, const RenderRequest& request, Pictures& out);
  bool isRepeat(const Eye& eye, const std::optional<Drawn>& drawn, const Overlays& overlays, const StateView& state,
                const RenderRequest& request) const;
  static Overlays overlaysOf(size_t camera, const RenderRequest& request);
  void follow(const StateView& state, bool all, const std::optional<HostDisplacements>& displacements);
  void draw(size_t eye, const StateView& state, const RenderRequest& request);
  void startReadback(Channel& channel, const Eye& eye, uint64_t tick);
  void readDrawn(Channel& channel, const Eye& eye);
  bool takeImage(Channel& channel, const Eye& eye, Pictures& out, bool wait);
  bool takeSurface(Pictures& out, bool wait);

  const Model& model_;
  const std::vector<StylusConfig> styluses_;
  Surface surface_;
  std::unique_ptr<Blanching> pale_skin_;  ///< null where no body blanches
  Renderer renderer_;
  CutState cuts_;
  std::unique_ptr<gpu::ReadbackRing> surface_ring_;
  struct Sent {  ///< contents of a surface in the ring
    std::shared_ptr<const VisibleWounds> wounds;
    bool colors, strain;
  };
  std::deque<Sent> in_flight_;           ///< oldest first
  std::unique_ptr<NodeOverlay> strain_;  ///< strain of surfaces; null until requested
  const double strain_range_;
  std::vector<Eye> eyes_;        ///< eyes of the cameras in their order, then right eyes
  std::vector<uint32_t> alive_;  ///< for the surface taken last
  ViewCounters counters_;
  uint64_t captures_ = 0;
  std::function<void()> pause_;
  const bool reads_late_;  ///< reading would block this thread
};

}  // namespace viscera
