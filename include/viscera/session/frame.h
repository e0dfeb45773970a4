// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "viscera/api.h"
#include "viscera/layout/limits.h"
#include "viscera/layout/tick_stats.h"
#include "viscera/math/types.h"
#include "viscera/model/scene/overlays.h"
#include "viscera/render/arrow.h"
#include "viscera/solver/needle_state.h"
#include "viscera/solver/process_visuals.h"
#include "viscera/solver/stability_monitor.h"
#include "viscera/solver/visible_tube.h"
#include "viscera/surface/skin_marks.h"
#include "viscera/surface/visible_mesh.h"
#include "viscera/tools/force_limiter.h"
#include "viscera/tools/stylus.h"
#include "viscera/tools/tick_contact.h"

namespace VISCERA_PUBLIC viscera {

/// Content of a camera image.
enum class PictureKind : uint8_t {
  kColor,   ///< colours that the camera sees
  kRight,   ///< colours that the right eye of a stereo camera sees
  kDepth,   ///< distance of the visible surface along the optical axis
  kLabels,  ///< label of the visible object (layout/picture_labels.h)
};
constexpr size_t kPictureKinds = 4;

/// Outputs that are requested of a tick; nothing else is mapped, drawn or read back.
struct FrameRequest {
  bool surface = false;
  std::vector<bool> cameras;  ///< [cameras] colour images; missing entries mean false
  bool every_image = false;   ///< wait rather than skip an image when too many are in flight
  /// [cameras] images of the other kinds; a camera with one eye has no right image.
  std::vector<bool> right = {}, depth = {}, labels = {};
  bool strain = false;  ///< strain colours of the surface (SurfaceFrame::strain_colors), where OpenGL is available

  bool image(size_t camera, PictureKind kind = PictureKind::kColor) const {
    return camera < of(kind).size() && of(kind)[camera];
  }
  const std::vector<bool>& of(PictureKind kind) const;  ///< [cameras] requested images of a kind
  std::vector<bool>& of(PictureKind kind);
  /// Returns the number of requested images and surfaces.
  size_t count() const;
};

/// Deformed surface mesh, some ticks late.
struct SurfaceFrame : VisibleMesh {
  uint64_t tick = 0;
  SteadyTime pose_received{};  ///< time at which the newest stylus pose of that tick was received; 0 if there was none
  /// [vertices] strain in the colours of overlay `strain` for the first camera, in the format of `colors`; empty where
  /// not requested
  std::vector<uint32_t> strain_colors = {};
};

/// Rendered image, rows from the top. Only the member of its kind is filled.
struct ImageFrame {
  uint64_t tick = 0;
  size_t camera = 0;
  PictureKind kind = PictureKind::kColor;
  int width = 0, height = 0;
  std::vector<uint8_t> rgb;     ///< RGB8, for kColor and kRight
  std::vector<float> depths_m;  ///< for kDepth: distance along the optical axis [m]; +Inf where nothing is (REP 117)
  std::vector<uint8_t> labels;  ///< for kLabels: layout/picture_labels.h; 0 where nothing is
  SteadyTime pose_received{};   ///< as in SurfaceFrame
};

/// Surface and images that are ready; empty where nothing was requested or nothing is ready yet.
struct Pictures {
  std::unique_ptr<SurfaceFrame> surface;
  std::vector<ImageFrame> images;
};

/// All results that came back after a tick.
struct Frame : Pictures {
  uint64_t tick = 0;
  std::array<Reaction, layout::kMaxStyluses> reactions;
  /// Times at which the poses behind the reactions were received; 0: none.
  std::array<SteadyTime, layout::kMaxStyluses> poses_received{};
  /// Moment about the pivot with which tissue between the jaws of each stylus keeps them open [N m].
  std::array<double, layout::kMaxStyluses> jaw_moments_nm{};
  /// Path of each tip and its contact in the tick of `stats`; kFree where it is not tracked.
  std::array<TickContact, layout::kMaxStyluses> contacts;
  layout::TickStats stats{};
  bool has_stats = false;  ///< stats are those of some recent tick
  Health health;
  /// The stylus appeared inside tissue, coming from an unknown side: it neither pushes nor gets a force until it has
  /// been outside.
  std::array<bool, layout::kMaxStyluses> inside{};
  bool shafts_touch = false;  ///< the shafts of the two styluses push each other, in the tick of `stats`
  std::array<bool, layout::kMaxStyluses> speed_limited{};  ///< the stylus was faster than tissue can follow
  ToolMotions tools;                 ///< motions of the tools in the tick: `to` is where they are shown
  std::vector<Pose> obstacles;       ///< [obstacles] poses at the end of the tick, tissue frame
  std::vector<Pose> cameras;         ///< [cameras] poses of the optical frames in the tick, tissue frame
  VisibleTubes sutures;              ///< sutures of the scene at the end of the tick, then the pieces cut from them
  VisibleTubes strands;              ///< open fibres of attachments, as images show them
  std::vector<NeedleState> needles;  ///< needles at the end of the tick
  /// Nodes that each stylus holds, in the frame of its tool [m]; empty here, filled by the code that shows them.
  std::array<std::vector<Vector3d>, layout::kMaxStyluses> held_m;
  /// [obstacles] force and torque of the tissue on each in the tick of `stats`, without limits; torque about its
  /// position at the end of the tick.
  std::vector<Reaction> obstacle_forces;
  std::shared_ptr<const VisibleMarks> marks;  ///< marks on the tissue; null: none
};

/// Tick that is to be shown.
struct RenderRequest {
  uint64_t tick = 0;
  ToolMotions motions;
  std::vector<Pose> obstacles;  ///< [obstacles] poses at the end of the tick, tissue frame
  std::vector<Pose> cameras;    ///< [cameras] poses of the optical frames, tissue frame
  ProcessVisuals processes;     ///< processes in the tissue at the end of the tick
  FrameRequest outputs;
  std::vector<Overlays> overlays;             ///< [cameras]
  std::vector<Arrow> arrows;                  ///< arrows of forces and wind, where some camera shows them
  std::shared_ptr<const VisibleMarks> marks;  ///< marks on the tissue; null: none
};

/// Work for display since the start: all stay zero without a subscriber.
struct ViewCounters {
  uint64_t mappings = 0;   ///< number of times that vertices were mapped to the nodes
  uint64_t renders = 0;    ///< number of images drawn
  uint64_t readbacks = 0;  ///< number of surfaces and images delivered
  uint64_t repeats = 0;    ///< number of delivered images that were not drawn again, as nothing had changed
  uint64_t skipped = 0;  ///< number of requested surfaces and images that were dropped because too many were in flight
  uint64_t wound_holes = 0;    ///< number of wounds that stay open now, because they reach a border of a surface mesh
  uint64_t wound_slivers = 0;  ///< number of surface edges now with a piece between two wounds that is not shown
  uint64_t moved_bricks = 0;   ///< number of bricks that had changed when a state on the host was copied to the GPU
};

}  // namespace viscera
