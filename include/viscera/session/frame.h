// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "viscera/layout/limits.h"
#include "viscera/layout/tick_stats.h"
#include "viscera/math/types.h"
#include "viscera/model/scene/overlays.h"
#include "viscera/render/arrow.h"
#include "viscera/solver/governor.h"
#include "viscera/solver/process_look.h"
#include "viscera/solver/seen_needle.h"
#include "viscera/solver/shown_thread.h"
#include "viscera/surface/shown_mesh.h"
#include "viscera/tools/force_limiter.h"
#include "viscera/tools/stylus.h"
#include "viscera/tools/tick_contact.h"

namespace viscera {

/// What a picture of a camera holds.
enum class PictureKind : uint8_t {
  kColor,   ///< what it sees
  kRight,   ///< what the right eye of a stereo camera sees
  kDepth,   ///< how far along the optical axis that lies
  kLabels,  ///< what it is (layout/picture_labels.h)
};
constexpr size_t kPictureKinds = 4;

/// What is wanted of this tick; nothing else is mapped, drawn or read back.
struct Wants {
  bool surface = false;
  std::vector<bool> cameras;  ///< [cameras]; shorter means false
  bool every_image = false;   ///< wait rather than skip an image when too many are on their way
  std::vector<bool> right = {}, depth = {}, labels = {};  ///< as cameras, of the other kinds; one eye has no right one
  bool strain = false;  ///< with the surface, as far as there is OpenGL: SurfaceFrame::strain_colors

  bool image(size_t camera, PictureKind kind = PictureKind::kColor) const {
    return camera < of(kind).size() && of(kind)[camera];
  }
  const std::vector<bool>& of(PictureKind kind) const;  ///< [cameras]
  std::vector<bool>& of(PictureKind kind);
  /// How many images and surfaces.
  size_t count() const;
};

/// The deformed skin, some ticks late.
struct SurfaceFrame : ShownMesh {
  uint64_t tick = 0;
  SteadyTime pose_received{};  ///< of the newest stylus pose in that tick; 0 if there was none
  /// [vertices] strain as overlay `strain` shows it to the first camera, as `colors`; empty where it was not wanted
  std::vector<uint32_t> strain_colors = {};
};

/// One rendered image, rows from the top: what its kind says is there, the rest is empty.
struct ImageFrame {
  uint64_t tick = 0;
  size_t camera = 0;
  PictureKind kind = PictureKind::kColor;
  int width = 0, height = 0;
  std::vector<uint8_t> rgb;     ///< of kColor and kRight: RGB8
  std::vector<float> depths_m;  ///< of kDepth: along the optical axis; +Inf where nothing is (REP 117)
  std::vector<uint8_t> labels;  ///< of kLabels: layout/picture_labels.h; 0 where nothing is
  SteadyTime pose_received{};   ///< as in SurfaceFrame
};

/// What there is to see; empty where nothing was wanted or nothing is ready yet.
struct Pictures {
  std::unique_ptr<SurfaceFrame> surface;
  std::vector<ImageFrame> images;
};

/// What came back after a tick.
struct Frame : Pictures {
  uint64_t tick = 0;
  std::array<Reaction, layout::kMaxStyluses> reactions;
  std::array<SteadyTime, layout::kMaxStyluses> poses_received{};  ///< of the poses that the reactions answer; 0: none
  /// With which what is between the jaws of each stylus keeps them open, about their pivot [N m].
  std::array<double, layout::kMaxStyluses> jaw_moments_nm{};
  /// The way of each tip, and what it met, in the tick that `stats` is of; kFree where it is not tracked.
  std::array<TickContact, layout::kMaxStyluses> contacts;
  layout::TickStats stats{};
  bool has_stats = false;  ///< stats are those of some recent tick
  Health health;
  /// The stylus appeared inside tissue, from an unknown side: it pushes and feels nothing until it was outside.
  std::array<bool, layout::kMaxStyluses> inside{};
  std::array<bool, layout::kMaxStyluses> held_back{};  ///< the stylus was faster than tissue can follow
  ToolMotions tools;                                   ///< of the tick: `to` is where the tools are shown
  std::vector<Pose> obstacles;                         ///< [obstacles] at the end of the tick, tissue frame
  std::vector<Pose> cameras;                           ///< [cameras] optical frames of the tick, tissue frame
  ShownThreads threads;             ///< at the end of the tick: threads of the scene, then what was parted from them
  std::vector<SeenNeedle> needles;  ///< likewise
  /// Nodes that each stylus holds, in the frame of its tool [m]; empty here, filled by who shows them.
  std::array<std::vector<Vector3d>, layout::kMaxStyluses> held_m;
  /// [obstacles] what the tissue does to each, not limited; torque about its place at the end of the tick. Of `stats`.
  std::vector<Reaction> obstacle_forces;
};

/// A tick that is to be looked at.
struct Look {
  uint64_t tick = 0;
  ToolMotions motions;
  std::vector<Pose> obstacles;  ///< [obstacles] at the end of the tick, tissue frame
  std::vector<Pose> cameras;    ///< [cameras] optical frames, tissue frame
  ProcessLook processes;        ///< at the end of the tick
  Wants wants;
  std::vector<Overlays> overlays;  ///< [cameras]
  std::vector<Arrow> arrows;       ///< forces and wind, where some camera shows them
};

/// Work done for the eye since the start: with no subscriber all stay zero.
struct ViewCounters {
  uint64_t mappings = 0;       ///< times that vertices were brought to the nodes
  uint64_t renders = 0;        ///< images drawn
  uint64_t readbacks = 0;      ///< surfaces and images handed over
  uint64_t repeats = 0;        ///< ... images of these that were not drawn again: nothing had changed
  uint64_t skipped = 0;        ///< surfaces and images that were wanted and overtaken, as too many were under way
  uint64_t wound_holes = 0;    ///< now: wounds that stay open, as they run out of a skin at a border of it
  uint64_t wound_slivers = 0;  ///< now: edges of skins of which a piece between two wounds is not shown
  uint64_t moved_bricks = 0;   ///< bricks that had changed when a state on the host was brought to the GPU
};

}  // namespace viscera
