// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <vector>

#include "viscera/model/scene/camera_config.h"
#include "viscera/tools/stylus.h"

namespace viscera {

struct StylusConfig;

/// Shadow of the tools on tissue, for tissue.frag. It shows the user how far a tool is.
struct ToolShadows {
  using Vector4 = std::array<float, 4>;
  int count = 0;
  float contact = 0;                               ///< CameraConfig::contact_shadows
  std::array<Vector4, layout::kMaxStyluses> tips;  ///< xyz m, optical frame; w radius of a ball at the tip [m]
  std::array<Vector4, layout::kMaxStyluses> ends;  ///< xyz m, optical frame; w radius of the shaft [m]
};

ToolShadows toolShadows(const ToolMotions& motions, const std::vector<StylusConfig>& styluses,
                        const CameraConfig& camera, const Pose& optical_from_tissue);

}  // namespace viscera
