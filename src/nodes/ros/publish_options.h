// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace viscera::nodes {

/// How what the simulation makes is sent.
struct PublishOptions {
  double surface_rate_hz = 30;       ///< most often that the surface and `scene_markers` are sent
  double force_arrow_m_per_n = 0.1;  ///< length of the arrows in `scene_markers`
  std::string frame_prefix;          ///< of the frames of tools and cameras; the scene's tissue frame has it already
};

}  // namespace viscera::nodes
