// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tools/motion_packing.h"

#include <algorithm>

#include "model/scene/tool_kinds.h"
#include "tools/scissors_edge.h"

namespace viscera {

namespace {

layout::vec4 pack(const Vector3d& v, double w) {
  return {static_cast<float>(v.x()), static_cast<float>(v.y()), static_cast<float>(v.z()), static_cast<float>(w)};
}

/// Sets the capsule of a shaft that tissue meets. @param from, to  poses at the start and the end of the substep
void setShaft(const StylusMotion& motion, const StylusConfig& config, const Pose& from, const Pose& to, double begin,
              double end, layout::ToolMotion& out) {
  const double change_m = motion.shaft_to_m - motion.shaft_from_m, far_m = config.shaft_length_m;
  const double begin_m = motion.shaft_from_m + begin * change_m, end_m = motion.shaft_from_m + end * change_m;
  if (std::max(begin_m, end_m) >= far_m) return;  // all of it is a blade or a jaw
  const Vector3d slid = motion.slid_to_m - motion.slid_from_m;
  const auto at = [&](const Pose& pose, double share, double z_m, double w) {
    return pack(pose * Vector3d(Vector3d(0, 0, z_m) - motion.slid_from_m - share * slid), w);
  };
  out.shaft_from = at(from, begin, begin_m, std::max(shaftRadius(config), motion.feels_m));
  out.shaft_to = at(to, end, end_m, 0);
  out.shaft_far_from = at(from, begin, far_m, 0);
  out.shaft_far_to = at(to, end, far_m, 0);
  out.info.y |= layout::kToolShaft;
}

layout::ToolMotion substep(const StylusMotion& motion, const StylusConfig& config, double begin, double end) {
  const Pose from = interpolate(motion.from, motion.to, begin);
  const Pose to = interpolate(motion.from, motion.to, end);
  const ToolKind& kind = kindOf(motion.mode);
  const BladeSpan blade = bladeSpan(config.cut);
  const Vector3d near_end(0, 0, kind.severs() ? blade.high_m : 0), far_end(0, 0, blade.low_m);
  layout::ToolMotion out{};  // TissueStepper sets the length of the previous substep
  out.from = pack(from * near_end, kind.reach_m(config));
  out.to = pack(to * near_end, kind.grip ? kind.grip(config).release_speed_m_per_s : 0);
  out.orientation = pack(to.orientation.vec(), to.orientation.w());
  out.blade_from = pack(from * far_end, config.cut_particles.eraser_radius_m);
  out.blade_to = pack(to * far_end, 0);
  out.info = toolInfo(motion.mode);
  out.info.y = effectsOf(motion);
  if (kind.closes) {
    const double from_rad = motion.opens_from_rad, change_rad = motion.opens_to_rad - from_rad;
    setEdge(scissorsOf(config.scissors),
            {from, to, from_rad + begin * change_rad, from_rad + end * change_rad, motion.mouth_rad}, out);
  }
  if (motion.shaft_to_m >= 0) setShaft(motion, config, from, to, begin, end, out);
  if (motion.feels_m > 0) out.info.y |= layout::kToolFeels;
  if (motion.feels_m > 0 && kind.does(kPushes)) out.from.w = static_cast<float>(motion.feels_m);
  return out;
}

}  // namespace

uint32_t effectsOf(const StylusMotion& motion) {
  const ToolKind& kind = kindOf(motion.mode);
  const bool rests = kind.closes && motion.opens_from_rad <= motion.opens_to_rad;
  return rests ? kind.effects & ~uint32_t{kCuts} : kind.effects;
}

Vector3d turnOfShaft(const StylusMotion& motion) {
  if (motion.shaft_to_m < 0) return Vector3d::Zero();
  const Eigen::AngleAxisd turn(motion.to.orientation * motion.from.orientation.conjugate());
  return turn.angle() * turn.axis();
}

layout::uvec4 toolInfo(ToolMode mode) {
  return {kindOf(mode).number, kindOf(mode).effects, 0, 0};
}

void interpolateMotions(const ToolMotions& motions, const std::vector<StylusConfig>& configs, int substeps,
                        std::vector<layout::ToolMotion>& out) {
  out.assign(static_cast<size_t>(substeps) * layout::kMaxStyluses, layout::ToolMotion{});
  for (size_t i = 0; i < configs.size(); ++i) {
    if (motions[i].mode == ToolMode::kNone && motions[i].shaft_to_m < 0) continue;
    for (int s = 0; s < substeps; ++s) {
      out[static_cast<size_t>(s) * layout::kMaxStyluses + i] =
          substep(motions[i], configs[i], static_cast<double>(s) / substeps, static_cast<double>(s + 1) / substeps);
    }
  }
}

}  // namespace viscera
