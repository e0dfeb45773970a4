// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "viscera/solver/governor.h"
#include "viscera/tools/stylus.h"

namespace viscera {

/// What somebody wants to see of this tick; nothing else is mapped, drawn or read back.
struct Wants {
  bool surface = false;
  std::vector<bool> cameras;  ///< [cameras]; shorter means false
  bool every_image = false;   ///< wait rather than skip an image when too many are on their way

  bool image(size_t camera) const { return camera < cameras.size() && cameras[camera]; }
  /// How many images and surfaces.
  size_t count() const;
};

/// Deformed skin as it left the GPU, some ticks late.
struct SurfaceFrame {
  uint64_t tick = 0;
  SteadyTime pose_received{};      ///< of the newest stylus pose in that tick; 0 if there was none
  std::vector<float> positions_m;  ///< [3 * vertices] tissue frame
  std::vector<uint32_t> normals;   ///< [vertices] packed
  std::vector<uint32_t> alive;     ///< [triangles] as in Surface::alive(): 1 whole, 0 torn
};

/// One rendered image, RGB8, rows from the top.
struct ImageFrame {
  uint64_t tick = 0;
  size_t camera = 0;
  int width = 0, height = 0;
  std::vector<uint8_t> rgb;
  SteadyTime pose_received{};  ///< as in SurfaceFrame
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
  layout::TickStats stats{};
  bool has_stats = false;  ///< stats are those of some recent tick
  Health health;
  std::array<bool, layout::kMaxStyluses> held_back{};  ///< the stylus was faster than tissue can follow
};

}  // namespace viscera
