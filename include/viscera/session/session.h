// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "viscera/gpu/context.h"
#include "viscera/gpu/readback.h"
#include "viscera/model/model.h"
#include "viscera/render/renderer.h"
#include "viscera/solver/solver.h"
#include "viscera/surface/surface.h"
#include "viscera/tools/stylus.h"

namespace viscera {

/// What somebody wants to see of this tick; nothing else is mapped, drawn or read back.
struct Wants {
  bool surface = false;
  std::vector<bool> cameras;  ///< [cameras]; shorter means false
  bool every_image = false;   ///< wait for the GPU rather than skip an image when too many are on their way
};

/// Deformed skin as it left the GPU, at most a frame late.
struct SurfaceFrame {
  uint64_t tick = 0;
  std::vector<float> positions_m;  ///< [3 * vertices] tissue frame
  std::vector<uint32_t> normals;   ///< [vertices] packed
  std::vector<uint32_t> alive;     ///< [triangles] 1 whole, 0 torn
};

/// One rendered image, RGB8, rows from the top.
struct ImageFrame {
  uint64_t tick = 0;
  size_t camera = 0;
  int width = 0, height = 0;
  std::vector<uint8_t> rgb;
};

/// What came back after a tick; members are empty where nothing was wanted or nothing is ready yet.
struct Frame {
  uint64_t tick = 0;
  std::array<Reaction, layout::kMaxStyluses> reactions;
  layout::TickStats stats{};
  bool has_stats = false;  ///< stats are those of some recent tick
  Health health;
  std::array<bool, layout::kMaxStyluses> held_back{};  ///< the stylus was faster than tissue can follow
  std::unique_ptr<SurfaceFrame> surface;
  std::vector<ImageFrame> images;
};

/// Work done since the start, for diagnostics: with no subscriber the last three stay zero.
struct Counters {
  uint64_t ticks = 0, substeps = 0, mappings = 0, renders = 0, readbacks = 0;
};

/// The worst since the start or the last reset.
struct Extremes {
  double peak_force_n = 0;  ///< largest force on any stylus, before saturation
  double max_stretch = 0;   ///< largest |L - l0| / l0
  double max_speed_m_per_s = 0;
  uint64_t nonfinite = 0;       ///< largest number of non-finite nodes in a tick
  uint64_t governor_trips = 0;  ///< ticks rolled back
  uint64_t held_back = 0;       ///< ticks in which a stylus was faster than tissue can follow
};

/// ONE loop: owns model, solver, surface and renderer on the thread that made it.
class Session {
 public:
  /// @throws GpuError, MeshError, LatticeError, SceneError
  Session(const Scene& scene, gpu::Context& context, const Progress& progress = {});
  ~Session();

  Frame step(const StylusSamples& samples, const Wants& wants);
  void reset();
  /// Waits for everything asked for so far; images and surface of the last ticks.
  Frame drain();
  uint64_t stateHash() const;

  const Scene& scene() const { return scene_; }
  const Model& model() const { return model_; }
  const Surface& surface() const { return *surface_; }
  const Solver& solver() const { return *solver_; }
  Counters counters() const;
  const Extremes& extremes() const { return extremes_; }
  /// Is the coming step one of those after which this camera, at its rate_hz, has a picture?
  bool imageDue(size_t camera) const;
  double tick_s() const { return 1.0 / scene_.solver.tick_hz; }
  uint64_t tick() const { return tick_; }

 private:
  void capture(const Wants& wants, const ToolMotions& motions, Frame& frame);
  void collect(Frame& frame, bool wait);
  bool takeImage(size_t camera, Frame& frame, bool wait);
  void collectStats(Frame& frame, bool wait);

  Scene scene_;
  Model model_;
  Tools tools_;
  std::unique_ptr<Solver> solver_;
  std::unique_ptr<Surface> surface_;
  std::unique_ptr<Renderer> renderer_;
  std::unique_ptr<gpu::ReadbackRing> surface_ring_;
  std::vector<std::unique_ptr<gpu::ReadbackRing>> image_rings_;
  std::vector<ForceLimiter> limiters_;
  layout::TickStats stats_{};
  std::array<Reaction, layout::kMaxStyluses> reactions_;
  Extremes extremes_;
  bool has_stats_ = false;
  uint64_t tick_ = 0, readbacks_ = 0, ticks_ = 0;
};

}  // namespace viscera
