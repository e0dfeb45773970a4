// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace viscera::nodes {

/// Options of the published topics.
struct PublishOptions {
  double surface_rate_hz = 30;       ///< largest rate of the surface and of `scene_markers` [Hz]
  double force_arrow_m_per_n = 0.1;  ///< length of the arrows in `scene_markers` [m/N]
  std::string frame_prefix;          ///< prefix of tools' and cameras' frames; the scene's tissue frame has it already
};

}  // namespace viscera::nodes
