// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "render/tool_shadows.h"

#include <algorithm>

#include "render/tool_shape.h"

namespace viscera {

namespace {
ToolShadows::Vector4 withRadius(const Vector3d& point_m, double radius_m) {
  const Eigen::Vector4f v = Eigen::Vector4d(point_m.x(), point_m.y(), point_m.z(), radius_m).cast<float>();
  return {v.x(), v.y(), v.z(), v.w()};
}
}  // namespace

ToolShadows toolShadows(const ToolMotions& motions, const std::vector<StylusConfig>& styluses,
                        const Pose& optical_from_tissue) {
  ToolShadows shadows;
  for (size_t stylus = 0; stylus < std::min(motions.size(), styluses.size()); ++stylus) {
    const StylusMotion& motion = motions[stylus];
    if (!motion.present) continue;
    const Pose optical_from_stylus = optical_from_tissue * motion.to;
    const double ball_m = motion.mode == ToolMode::kProbe ? styluses[stylus].probe_radius_m : 0;
    const size_t at = static_cast<size_t>(shadows.count++);
    shadows.tips[at] = withRadius(optical_from_stylus.position_m, ball_m);
    shadows.ends[at] = withRadius(optical_from_stylus * Vector3d(0, 0, kShaftLength_m), kShaftRadius_m);
  }
  return shadows;
}

}  // namespace viscera
