// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "render/tool_shadows.h"

#include <algorithm>

#include "model/scene/tool_kinds.h"
#include "render/shapes/tool_shape.h"

namespace viscera {

namespace {
ToolShadows::Vector4 withRadius(const Vector3d& point_m, double radius_m) {
  const Eigen::Vector4f v = Eigen::Vector4d(point_m.x(), point_m.y(), point_m.z(), radius_m).cast<float>();
  return {v.x(), v.y(), v.z(), v.w()};
}
}  // namespace

ToolShadows toolShadows(const ToolMotions& motions, const std::vector<StylusConfig>& styluses,
                        const CameraConfig& camera, const Pose& optical_from_tissue) {
  ToolShadows shadows;
  shadows.contact = static_cast<float>(camera.contact_shadows);
  for (size_t stylus = 0; stylus < std::min(motions.size(), styluses.size()); ++stylus) {
    const StylusMotion& motion = motions[stylus];
    if (!motion.present) continue;
    const Pose optical_from_stylus = optical_from_tissue * motion.to;
    const ToolKind& kind = kindOf(motion.mode);
    const double ball_m = kind.tip == ToolTip::kBall ? kind.reach_m(styluses[stylus]) : 0;
    const size_t at = static_cast<size_t>(shadows.count++);
    shadows.tips[at] = withRadius(optical_from_stylus.position_m, ball_m);
    shadows.ends[at] = withRadius(optical_from_stylus * Vector3d(0, 0, styluses[stylus].shaft_length_m),
                                  shaftRadius(styluses[stylus]));
  }
  return shadows;
}

}  // namespace viscera
